"""Whole outlines and centres: from a cap's mark where it has one, else from what is visible of it.

Neighbours matter only where they touch, so a single cap is reconstructed among those around it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TypeVar

import msgspec

from fairyring.app.caps.image_caps import Scene, scene_of
from fairyring.app.protocol import Arc, Fit, Refit
from fairyring.model.contour.marks import whole_of_mark
from fairyring.model.contour.reconstruct import Reconstruction, reconstruct
from fairyring.model.contour.result import Arc as FoundArc
from fairyring.model.geometry.outline_checks import check_mark, check_outline
from fairyring.model.geometry.shapes import Circle, GeometryError, Polygon
from fairyring.model.progress import Progress, silent
from fairyring.storage import derived
from fairyring.storage.contents import load_annotations, load_contents, load_predictions
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.journal import Derived
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Cap, Edit, Image, Mark, Outline, Shape

Key = TypeVar("Key")
REACH = 0.5
"""How far around a cap, as a share of its size, others still count as its neighbours."""


@dataclass(frozen=True)
class Whole:
    """What was worked out for a cap, or why there is nothing."""

    shape: Shape | None
    note: str
    centre_sd: tuple[float, float] | None = None
    """One standard deviation along x and y, pixels; None for a mark."""
    arcs: tuple[FoundArc, ...] = ()
    """The visible outline cut up; empty for a mark."""

    @property
    def centre(self) -> tuple[float, float] | None:
        """Of the whole outline."""
        return (self.shape.cx, self.shape.cy) if self.shape else None


def whole_of(uid: str, cap: Cap, scene: Scene) -> Whole:
    """The whole outline of one cap among the others of its image.

    The cap is checked first, as the rasteriser must never see anything wild; the scene was checked before.
    """
    width, height = scene.image.width, scene.image.height
    try:
        if cap.mark is not None:
            return _from_mark(check_mark(cap.mark, width=width, height=height))
        outline = check_outline(cap.visible, width=width, height=height)
    except GeometryError as error:
        return Whole(None, str(error))
    others = scene.near(uid, outline, prediction=cap.prediction, reach=REACH)
    return _wholes([outline, *others], [0], image=scene.image)[0]


def wholes_of(outlines: Sequence[Outline], image: Image) -> list[Whole]:
    """The whole outline of every cap of an image, each worked out among the others.

    The outlines were checked before.
    """
    return _wholes(outlines, range(len(outlines)), image=image)


def refit(scene: Scene, request: Refit) -> Fit:
    """Answers a refit: the whole outline of a cap as it is selected or dragged, and how it came about."""
    whole = whole_of(request.annotation, request.cap, scene)
    return Fit(
        seq=request.seq,
        annotation=request.annotation,
        whole=whole.shape,
        centre=whole.centre,
        centre_sd=whole.centre_sd,
        arcs=[Arc(kind=arc.kind, points=arc.points.round(2).ravel().tolist()) for arc in whole.arcs],
        note=whole.note,
    )


def derive_edits(project: Project, edits: Sequence[Edit], *, known: Scene | None = None) -> list[Derived]:
    """Works out whole outlines and centres for a change set, as the images stand with the whole set in it.

    ``known`` saves loading the image it shows. Edits that make no sense are left to the journal to refuse.
    """
    scenes = {known.image.id: known} if known else {}
    with project.read() as connection:
        for image_id in {edit.image for edit in edits} - scenes.keys():
            with suppress(StoreError):
                scenes[image_id] = scene_of(load_contents(connection, image_id))
    for image_id, scene in scenes.items():
        scenes[image_id] = _with_edits(scene, [edit for edit in edits if edit.image == image_id])
    return [_derive(edit, scenes.get(edit.image)) for edit in edits]


def fill_in(project: Project, image_ids: Sequence[int] | None = None, *, progress: Progress = silent) -> int:
    """Works out every whole outline and centre that is missing; returns how many were stored.

    ``image_ids`` None means the whole project. Each image is stored by itself, so that a later call goes on
    where this one was stopped.
    """
    if image_ids is None:
        with project.read() as connection:
            image_ids = derived.images_with_underived(connection)
    stored = 0
    for done, image_id in enumerate(image_ids):
        progress(done, len(image_ids), "Finding whole outlines and centres")
        stored += _fill_in_image(project, image_id)
    return stored


def _fill_in_image(project: Project, image_id: int) -> int:
    with project.read() as connection:
        lacking = derived.underived_of(connection, image_id)
        image = get_image(connection, image_id)
        people = {a.uid: a for a in load_annotations(connection, image_id)}
        model = {p.id: p for p in load_predictions(connection, image_id)}
    marks = {uid: mark for uid in lacking.annotations if (mark := people[uid].cap.mark) is not None}
    unmarked = [uid for uid in lacking.annotations if uid not in marks]
    wholes = {uid: _from_mark(mark) for uid, mark in marks.items()}
    wholes |= _wholes_among({uid: a.cap.visible for uid, a in people.items()}, unmarked, image=image)
    seen = _wholes_among({key: p.visible for key, p in model.items()}, lacking.predictions, image=image)
    annotation_fits = [
        derived.AnnotationFit(uid=uid, revision=people[uid].revision, fit=_stored(whole))
        for uid, whole in wholes.items()
    ]
    prediction_fits = [derived.PredictionFit(id=key, fit=_stored(whole)) for key, whole in seen.items()]
    return project.write(
        lambda connection: derived.store_derived(
            connection, image_id, annotations=annotation_fits, predictions=prediction_fits
        )
    )


def _wholes_among(caps: Mapping[Key, Outline], wanted: Sequence[Key], *, image: Image) -> dict[Key, Whole]:
    place = {key: index for index, key in enumerate(caps)}
    found = _wholes(list(caps.values()), [place[key] for key in wanted], image=image)
    return dict(zip(wanted, found, strict=True))


def _wholes(caps: Sequence[Outline], wanted: Sequence[int], *, image: Image) -> list[Whole]:
    found = reconstruct(caps, width=image.width, height=image.height, only=wanted)
    return [_from_reconstruction(one) for one in found]


def _from_reconstruction(found: Reconstruction) -> Whole:
    return Whole(found.whole, found.refusal or found.why, centre_sd=found.centre_sd, arcs=found.arcs)


def _from_mark(mark: Mark) -> Whole:
    shape = whole_of_mark(mark)
    if shape is None:
        return Whole(None, "The mark determines no outline; place more points around the cap.")
    if isinstance(mark, Polygon):
        return Whole(shape, "ellipse fitted to the marked polygon")
    return Whole(shape, "the marked circle" if isinstance(mark, Circle) else "the marked ellipse")


def _stored(whole: Whole) -> derived.Fit:
    return derived.Fit(
        whole=whole.shape, centre=whole.centre, refusal=whole.note if whole.shape is None else None
    )


def _derive(edit: Edit, scene: Scene | None) -> Derived:
    if edit.cap is None or scene is None:
        return Derived(edit=edit)
    fit = _stored(whole_of(edit.annotation, edit.cap, scene))
    return Derived(edit=edit, whole=fit.whole, centre=fit.centre, refusal=fit.refusal)


def _with_edits(scene: Scene, edits: Sequence[Edit]) -> Scene:
    """The scene once these edits are accepted, as far as their outlines can be used."""
    annotations = dict(scene.annotations)
    for edit in edits:
        annotations.pop(edit.annotation, None)
        if edit.cap is not None and (outline := _usable(edit.cap.visible, scene.image)) is not None:
            cap = msgspec.structs.replace(edit.cap, visible=outline)
            annotations[edit.annotation] = Annotation(
                uid=edit.annotation, image=edit.image, revision=edit.base, cap=cap
            )
    return replace(scene, annotations=annotations)


def _usable(visible: Outline, image: Image) -> Outline | None:
    try:
        return check_outline(visible, width=image.width, height=image.height)
    except GeometryError:
        return None
