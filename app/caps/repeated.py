"""What second marks of caps say of the people who placed them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from msgspec import to_builtins
from sqlalchemy import Connection

from fairyring.app.caps.records import class_of_mark, floor_of_mark, shape_of_mark
from fairyring.model.contour.marks import reconstruction_of_mark
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.human_floor import cdr_of_noise
from fairyring.model.evaluate.repeated_marks import (
    ENOUGH,
    UNKNOWN,
    CapClass,
    Hands,
    RepeatedMark,
    floor_between,
    floor_of_repeats,
    floors_by_class,
    hands_of,
)
from fairyring.storage.compared_caps import scale_floors
from fairyring.storage.contents import load_editors
from fairyring.storage.records import IMPORT, Annotation, Image, Repeat
from fairyring.storage.repeats import all_repeats


@dataclass(frozen=True, kw_only=True)
class Marks:
    """What is known of the people who marked the caps of an image."""

    editors: Mapping[str, str] = field(default_factory=dict)
    """Who edited each annotation last, by uid."""
    hands: Hands = UNKNOWN

    @property
    def annotator(self) -> str | None:
        """Who edited most of these annotations; None where there are none."""
        return min(Counter(self.editors.values()).items(), key=_most_first, default=(None, 0))[0]

    def class_of(self, cap: Annotation, record: CapRecord) -> CapClass:
        """What kind of mark a cap has, and whose."""
        return class_of_mark(record, cap.cap.mark, annotator=self.editors.get(cap.uid, IMPORT))

    def floor_of(self, cap: Annotation, record: CapRecord, image: Image) -> float | None:
        """CDR, percent, that a mark has by itself; None where that is not known."""
        return self.hands.floor(self.class_of(cap, record), floor_of_mark(cap, image))


def _most_first(counted: tuple[str, int]) -> tuple[int, str]:
    name, count = counted
    return -count, name


def marks_on(connection: Connection, image_id: int) -> Marks:
    """What is known of the people who marked the caps of this image."""
    return Marks(editors=load_editors(connection, image_id), hands=hands_known(connection))


def repeated_marks(connection: Connection) -> list[RepeatedMark]:
    """All caps that were marked twice; those of which a mark tells no centre are left out."""
    found = (_repeated(each, width, height) for each, width, height in all_repeats(connection))
    return [each for each in found if each is not None]


def hands_known(connection: Connection) -> Hands:
    """How far off people's marks are, as far as repeats tell."""
    return hands_of(repeated_marks(connection))


def use_repeats(connection: Connection, annotator: str) -> None:
    """Has what was compared before go by what repeats say of this person now; within ``Project.write``."""
    hands = hands_known(connection)
    overall = hands.by_annotator.get(annotator)
    if overall is not None:
        theirs = {of: times for of, times in hands.by_class.items() if of.annotator == annotator}
        by_class = {(of.size, of.shape, of.visibility): times for of, times in theirs.items()}
        scale_floors(connection, annotator, overall=overall, by_class=by_class)


def floor_figures(repeats: list[RepeatedMark]) -> dict[str, Any]:
    """What ``fairyring review --json`` says of them: floors with their intervals, overall and by class."""
    return {
        "count": len(repeats),
        "enough": ENOUGH,
        "all": to_builtins(floor_of_repeats(repeats)),
        "by": to_builtins(floors_by_class(repeats)),
    }


def _repeated(each: Repeat, width: int, height: int) -> RepeatedMark | None:
    first, second = reconstruction_of_mark(each.first).fit, reconstruction_of_mark(each.second).fit
    if first.centre is None or second.centre is None:
        return None
    sd = first.centre_sd
    return RepeatedMark(
        of=CapClass(
            annotator=each.user,
            size=each.size,
            shape=shape_of_mark(each.first),
            visibility=each.visibility,
        ),
        image=each.image,
        floor=floor_between(first.centre, second.centre, width=width, height=height),
        expected=None if sd is None else cdr_of_noise(sd, width=width, height=height),
    )
