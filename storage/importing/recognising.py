"""Recognises the caps of a file among others: those of the project, or of a file read before it."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from fairyring.model.geometry.likeness import overlaps
from fairyring.model.geometry.shapes import Outline, polygon_of_shape
from fairyring.storage.formats.coco_geometry import written_outline
from fairyring.storage.formats.found import FoundCap
from fairyring.storage.records import Annotation

SAME_CAP = 0.5
"""Least IoU of two outlines of one cap."""
DOUBLE = 0.9
"""IoU from which a cap is no second one beside another, whatever files say."""


class Trait(Struct, frozen=True, kw_only=True):
    """By what a cap is recognised."""

    uid: str | None
    id: int | None
    """Its number in a file, or in the project's exports."""
    outline: Outline


def trait_of_found(found: FoundCap) -> Trait:
    """Of a checked cap of a file."""
    outline = found.cap.visible
    if not outline and found.whole is not None:
        outline = [polygon_of_shape(found.whole)]
    return Trait(uid=found.uid, id=found.id, outline=outline)


def trait_of_annotation(annotation: Annotation, *, number: int, size: tuple[int, int]) -> Trait:
    """Of a cap of the project; ``size`` is the image's width and height."""
    outline = written_outline(annotation.cap.visible, annotation.cap.mark, size=size)
    return Trait(uid=annotation.uid, id=number, outline=outline)


def recognised(
    found: Sequence[Trait], known: Sequence[Trait], *, width: int, height: int, least_iou: float = SAME_CAP
) -> list[int | None]:
    """The index of the known cap that each found one is, or None; no two are the same.

    The uid decides. Else caps are the same whose IoU is at least ``least_iou``: first those with one id, as
    tools number caps anew, then those that overlap most.
    """
    by_uid = {trait.uid: nth for nth, trait in enumerate(known) if trait.uid is not None}
    same: list[int | None] = [None if each.uid is None else by_uid.pop(each.uid, None) for each in found]
    rest = [nth for nth, which in enumerate(same) if which is None]
    taken = {which for which in same if which is not None}
    free = [nth for nth in range(len(known)) if nth not in taken]
    shared = overlaps(
        [found[nth].outline for nth in rest],
        [known[nth].outline for nth in free],
        width=width,
        height=height,
    )
    pairs = [(rest[one], free[other], iou) for (one, other), iou in shared.items() if iou >= least_iou]
    pairs.sort(key=lambda pair: (not _one_id(found[pair[0]], known[pair[1]]), -pair[2], pair[:2]))
    for one, other, _ in pairs:
        if same[one] is None and other not in taken:
            same[one] = other
            taken.add(other)
    return same


def _one_id(one: Trait, other: Trait) -> bool:
    return one.id is not None and one.id == other.id
