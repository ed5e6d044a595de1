"""Whole outlines and centres: from a cap's mark where it has one, else from what is visible of all caps.

Every answer about a cap, live or stored, comes from `Fitting`, so that all of them agree.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Literal

import msgspec

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.caps.fitting import Seen
from fairyring.app.caps.image_caps import ImageCaps, caps_of
from fairyring.app.protocol import Arc, Fitted, Refit
from fairyring.model.contour.marks import reconstruction_of_mark
from fairyring.model.contour.result import Reconstruction
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.outline_checks import check_mark
from fairyring.model.geometry.shapes import Fit, GeometryError
from fairyring.storage.cap_validity import check_cap
from fairyring.storage.contents import load_contents
from fairyring.storage.errors import StoreError
from fairyring.storage.journal import Derived
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Cap, Edit, Image

TELLING = 0.005
"""A stored centre that a new fit would move by less than this, pixels, is as good as new."""


def reconstruction_of(uid: str, cap: Cap, caps: ImageCaps) -> Reconstruction:
    """The whole outline of one cap among the others of its image, and how it came about.

    It is what an edit with this cap stores. The cap is checked first, as the rasteriser must never see
    anything wild; the others were checked before.
    """
    try:
        if cap.mark is not None:
            return reconstruction_of_mark(
                check_mark(cap.mark, width=caps.image.width, height=caps.image.height)
            )
        outline = caps.checked_outline(uid, cap)
        seen = Seen(outline, caps.checked_arcs(uid, cap, outline))
    except GeometryError as error:
        return Reconstruction(fit=Fit(refusal=str(error)))
    visible = caps.visible_beside(uid, prediction=cap.prediction)
    (found,) = caps.fitting.reconstructions([seen], visible=visible)
    stored = _stored(uid, seen, caps)
    return found if stored is None else _as_stored(found, stored)


def refit(caps: ImageCaps, request: Refit) -> Fitted:
    """Answers a refit: the whole outline of a cap as it is selected or dragged, and how it came about."""
    found = reconstruction_of(request.annotation, request.cap, caps)
    return Fitted(
        seq=request.seq,
        annotation=request.annotation,
        fit=found.fit,
        arcs=arcs_of(found),
        note=note_of(found),
        mark=None if request.cap.mark is not None else _mark_for(found),
    )


def arcs_of(found: Reconstruction) -> list[Arc]:
    """The pieces of the visible outline as they are sent."""
    return [
        Arc(kind=arc.kind, points=arc.points.round(2).ravel().tolist(), told=arc.told) for arc in found.arcs
    ]


def _mark_for(found: Reconstruction) -> Literal["circle", "polygon"] | None:
    if found.fit.whole is None:
        return None
    return "circle" if found.shape == "regular" or found.proposal == "circle" else "polygon"


def note_of(found: Reconstruction) -> str:
    """Says how a whole outline came about, or why there is none."""
    return found.fit.refusal or found.why


def derive_edits(project: Project, edits: Sequence[Edit], *, known: ImageCaps | None = None) -> list[Derived]:
    """Works out whole outlines and centres for a change set, as the images stand with the whole set in it.

    ``known`` saves loading the image it shows. Edits that make no sense are left to the journal to refuse.
    """
    found: dict[str, Derived] = {}
    for image_id in {edit.image for edit in edits}:
        of_image = [edit for edit in edits if edit.image == image_id]
        caps = known if known and known.image.id == image_id else load_caps(project, image_id)
        if caps is not None:
            found |= {derived.edit.id: derived for derived in derived_of(caps, of_image)}
    return [found.get(edit.id) or Derived(edit=edit) for edit in edits]


def load_caps(project: Project, image_id: int) -> ImageCaps | None:
    """The caps of an image as they are stored; None where the project has no such image."""
    fill_in(project, [image_id])
    with suppress(StoreError), project.read() as connection:
        return caps_of(load_contents(connection, image_id))
    return None


def derived_of(caps: ImageCaps, edits: Sequence[Edit]) -> list[Derived]:
    """Checks the caps of edits of one image and fits them, as they stand with all of these edits in it."""
    seen = {edit.id: _checked(edit.annotation, edit.cap, caps) for edit in edits if edit.cap is not None}
    fits = _fits_of_edits(edits, seen, caps)
    return [_derived(edit, seen.get(edit.id), fits.get(edit.id, Fit()), caps.image) for edit in edits]


def _derived(edit: Edit, seen: Seen | None, fit: Fit, image: Image) -> Derived:
    if edit.cap is None:
        return Derived(edit=edit)
    try:
        # A repaired outline needs no second repair; why one cannot be used is found again at no cost.
        cap = edit.cap if seen is None else msgspec.structs.replace(edit.cap, visible=seen.outline)
        return Derived(edit=edit, fit=fit, checked=check_cap(cap, width=image.width, height=image.height))
    except FairyringError as error:
        return Derived(edit=edit, unfit=str(error))


def _stored(uid: str, seen: Seen, caps: ImageCaps) -> Fit | None:
    """The stored fit of an annotation whose outline is unchanged, which it keeps; else None."""
    before = caps.annotations.get(uid)
    if before is None or before.deleted or before.whole is None:
        return None
    if before.cap.mark is not None or (before.cap.visible, before.cap.told) != (seen.outline, seen.told):
        return None
    return Fit(whole=before.whole, centre=before.centre)


def _as_stored(found: Reconstruction, stored: Fit) -> Reconstruction:
    """The reconstruction with the stored fit in place of its own, and a remark where they differ."""
    fit = msgspec.structs.replace(found.fit, whole=stored.whole, centre=stored.centre, refusal=None)
    if found.fit.centre is None or stored.centre is None:
        return replace(found, fit=fit)
    apart = math.dist(found.fit.centre, stored.centre)
    if apart < TELLING:
        return replace(found, fit=fit)
    return replace(found, fit=fit, why=f"{found.why}; fitted anew its centre would move {apart:.2f} px")


def _fits_of_edits(
    edits: Sequence[Edit], checked: Mapping[str, Seen | None], caps: ImageCaps
) -> dict[str, Fit]:
    """Fits by edit id; none for deletions, nor for edits that a later one of the set replaces."""
    after = caps.with_annotations(_edited(caps, edits, checked))
    fits: dict[str, Fit] = {}
    wanted: dict[str, Seen] = {}
    for edit in {edit.annotation: edit for edit in edits}.values():
        if edit.cap is None:
            continue
        seen = checked[edit.id]
        if edit.cap.mark is not None or seen is None:
            fits[edit.id] = reconstruction_of(edit.annotation, edit.cap, caps).fit
        elif (stored := _stored(edit.annotation, seen, caps)) is not None:
            fits[edit.id] = stored
        else:
            wanted[edit.id] = seen
    found = caps.fitting.reconstructions(list(wanted.values()), visible=after.visible.values())
    return fits | {edit: each.fit for edit, each in zip(wanted, found, strict=True)}


def _checked(uid: str, cap: Cap, caps: ImageCaps) -> Seen | None:
    """The checked outline of a cap with what is said of it; None where it cannot be used."""
    try:
        outline = caps.checked_outline(uid, cap)
        return Seen(outline, caps.checked_arcs(uid, cap, outline))
    except GeometryError:
        return None


def _edited(
    caps: ImageCaps, edits: Sequence[Edit], checked: Mapping[str, Seen | None]
) -> dict[str, Annotation]:
    """The annotations once these edits are accepted; of outlines that cannot be used nothing is visible."""
    annotations = dict(caps.annotations)
    for edit in edits:
        known = annotations.get(edit.annotation)
        if edit.cap is not None:
            seen = checked[edit.id] or Seen([])
            cap = msgspec.structs.replace(edit.cap, visible=seen.outline, arcs=seen.told or msgspec.UNSET)
            annotations[edit.annotation] = Annotation(
                uid=edit.annotation, image=edit.image, revision=edit.base, cap=cap
            )
        elif known is not None:
            annotations[edit.annotation] = msgspec.structs.replace(known, deleted=True)
    return annotations
