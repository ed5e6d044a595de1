"""Compares the caps of files with those of the project: which are new, changed, the same, gone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import Struct, structs
from sqlalchemy import Connection, select

from fairyring.model.geometry.likeness import ROUNDING, are_alike, overlaps
from fairyring.model.geometry.shapes import Polygon
from fairyring.storage.db.rows import SELECT_ANNOTATIONS, annotation_of
from fairyring.storage.db.schema import annotation
from fairyring.storage.formats.coco_geometry import written_outline
from fairyring.storage.formats.found import FoundCap
from fairyring.storage.importing.photos import Photo
from fairyring.storage.importing.recognising import (
    DOUBLE,
    recognised,
    trait_of_annotation,
    trait_of_found,
)
from fairyring.storage.journal import history
from fairyring.storage.records import Annotation, Cap, Mark


class Change(Struct, frozen=True, kw_only=True):
    """A cap of the project, and what a file says of it."""

    annotation: Annotation
    cap: Cap
    """The cap as it would be; what the file does not speak of is as it is."""


class Compared(Struct, frozen=True, kw_only=True):
    """The caps that files say a photo has, beside those that the project says it has."""

    photo: Photo
    caps: Sequence[FoundCap]
    """All of them."""
    new: list[FoundCap]
    same: int = 0
    """How many the project knows just so, or knew so before somebody edited or deleted them."""
    changed: list[Change] = []
    deleted: list[Change] = []
    """Those that somebody deleted in the project."""
    gone: list[Annotation] = []
    """Caps of the project that no file has; ignored ones, which exports leave out, do not count."""
    revisions: dict[str, int] = {}
    """Of all caps of the photo, by uid, as they were compared."""

    @property
    def known(self) -> int:
        """How many caps of the files the project has or had."""
        return self.same + len(self.changed) + len(self.deleted)


def compare(connection: Connection, photo: Photo, caps: Sequence[FoundCap]) -> Compared:
    """Compares the checked caps that files have in one photo with the project's."""
    found, doubled = _without_doubles(caps, photo)
    if photo.id is None:
        return Compared(photo=photo, caps=caps, new=found, same=doubled)
    numbers, annotations = _annotations(connection, photo.id)
    if not annotations:
        return Compared(photo=photo, caps=caps, new=found, same=doubled)
    size = photo.width, photo.height
    live = [each for each in annotations if not each.deleted]
    dead = {each.uid: each for each in annotations if each.deleted}
    again = [(cap, dead[cap.uid]) for cap in found if cap.uid is not None and cap.uid in dead]
    found = [cap for cap in found if cap.uid not in dead]
    which = recognised(
        [trait_of_found(cap) for cap in found],
        [trait_of_annotation(each, number=numbers[each.uid], size=size) for each in live],
        width=photo.width,
        height=photo.height,
    )
    pairs = [(cap, live[nth]) for cap, nth in zip(found, which, strict=True) if nth is not None]
    unknown = [cap for cap, nth in zip(found, which, strict=True) if nth is None]
    left = [each for each in dead.values() if each.uid not in {known.uid for _, known in again}]
    gone_before = recognised(
        [trait_of_found(cap) for cap in unknown],
        [trait_of_annotation(each, number=numbers[each.uid], size=size) for each in left],
        width=photo.width,
        height=photo.height,
        least_iou=DOUBLE,
    )
    again += [(cap, left[nth]) for cap, nth in zip(unknown, gone_before, strict=True) if nth is not None]
    changes = [_change(connection, cap, known, size) for cap, known in pairs]
    met = {known.uid for _, known in pairs}
    return Compared(
        photo=photo,
        caps=caps,
        new=[cap for cap, nth in zip(unknown, gone_before, strict=True) if nth is None],
        same=doubled + changes.count(None),
        changed=[change for change in changes if change is not None],
        deleted=[Change(annotation=known, cap=_taken_over(cap, known.cap, size)) for cap, known in again],
        gone=[each for each in live if each.uid not in met and not each.cap.ignored],
        revisions={each.uid: each.revision for each in annotations},
    )


def is_as_compared(connection: Connection, compared: Compared, photo: Photo) -> bool:
    """Whether nobody has entered or edited caps of the photo since."""
    asked = select(annotation.c.uid, annotation.c.revision).where(annotation.c.image == photo.id)
    return compared.revisions == {row.uid: row.revision for row in connection.execute(asked)}


def _without_doubles(caps: Sequence[FoundCap], photo: Photo) -> tuple[list[FoundCap], int]:
    """The caps without those that an earlier file has already, and how many these are."""
    files: dict[str, list[FoundCap]] = {}
    for cap in caps:
        files.setdefault(cap.file, []).append(cap)
    kept, *others = files.values() if files else ([],)
    kept, doubled = list(kept), 0
    for told in others:
        which = recognised(
            [trait_of_found(cap) for cap in told],
            [trait_of_found(cap) for cap in kept],
            width=photo.width,
            height=photo.height,
            least_iou=DOUBLE,
        )
        fresh = [cap for cap, nth in zip(told, which, strict=True) if nth is None]
        doubled += len(told) - len(fresh)
        kept += fresh
    return kept, doubled


def _annotations(connection: Connection, image: int) -> tuple[dict[str, int], list[Annotation]]:
    """The numbers of an image's annotations by uid, and the annotations, deleted ones too."""
    statement = SELECT_ANNOTATIONS.where(annotation.c.image == image).order_by(annotation.c.id)
    rows = connection.execute(statement).all()
    return {row.uid: row.id for row in rows}, [annotation_of(row) for row in rows]


def _change(
    connection: Connection, found: FoundCap, known: Annotation, size: tuple[int, int]
) -> Change | None:
    """What a file changes about a cap; None where it says what the project says, or once said."""
    cap = _taken_over(found, known.cap, size)
    if cap == known.cap:
        return None
    if known.revision > 1:
        before = [entry.after for entry in history(connection, known.uid)]
        if any(_taken_over(found, once, size) == once for once in before if once is not None):
            return None
    return Change(annotation=known, cap=cap)


def _taken_over(found: FoundCap, known: Cap, size: tuple[int, int]) -> Cap:
    """A known cap with what a file says of it; it stays the same where that differs in rounding alone."""
    said = found.cap
    visible, mark = said.visible or known.visible, said.mark or known.mark
    if _is_outline_of(found, known, size):
        visible = known.visible
    if mark is not None and known.mark is not None and _same_mark(mark, known.mark):
        mark = known.mark
    return structs.replace(
        known,
        visible=visible,
        mark=mark,
        ignored=said.ignored or (known.ignored and not found.tells_ignored),
        doubtful=said.doubtful or (known.doubtful and not found.tells_doubtful),
        order=known.order if said.order is None else said.order,
        category=said.category,
        arcs=said.arcs or known.arcs,
    )


def _is_outline_of(found: FoundCap, known: Cap, size: tuple[int, int]) -> bool:
    """Whether a file has the outline, or the mask, that an export writes for a cap."""
    written = written_outline(known.visible, known.mark, size=size)
    if found.is_mask:
        width, height = size
        shared = overlaps([found.cap.visible], [written], width=width, height=height)
        return shared.get((0, 0)) == 1
    return are_alike(found.cap.visible, written)


def _same_mark(one: Mark, other: Mark) -> bool:
    if isinstance(one, Polygon) and isinstance(other, Polygon):
        return are_alike([one.points], [other.points])
    if isinstance(one, Polygon) or type(one) is not type(other):
        return False
    return np.allclose(structs.astuple(one), structs.astuple(other), rtol=0, atol=ROUNDING)
