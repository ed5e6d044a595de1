"""What a comparison says of each cap of an image, as it is kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from msgspec import structs

from fairyring.app.caps.records import floor_of_mark, is_unsure, prediction_record
from fairyring.app.caps.repeated import Marks
from fairyring.model.evaluate import centres
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.sizes import size_of_cap
from fairyring.storage.compared_caps import CapFigures
from fairyring.storage.records import Annotation, Image, Prediction


@dataclass(frozen=True, eq=False, kw_only=True)
class Sides:
    """What is compared: the caps that people drew with what is known of their marks, and predictions."""

    image: Image
    annotations: Sequence[Annotation]
    truths: Sequence[CapRecord]
    """The annotations as evaluation reads them, in the same order."""
    predictions: Sequence[Prediction]
    marks: Marks


def figures_of_caps(sides: Sides, found: centres.Comparison, *, run_id: int) -> list[CapFigures]:
    """Of every cap, those that count neither way last, and of every prediction that nobody drew."""
    alone = CapFigures(image=sides.image.id, run=run_id, annotation=None, prediction=None)
    matched = [_of_pair(sides, pair, alone) for pair in found.pairs]
    missed = [_with_mark(alone, sides, number) for number in found.missed]
    extra = [_extra(sides, number, alone) for number in found.extra]
    ignored = [nth for nth, each in enumerate(sides.annotations) if each.cap.ignored]
    return [*matched, *missed, *extra, *(_with_mark(alone, sides, number) for number in ignored)]


def _extra(sides: Sides, number: int, alone: CapFigures) -> CapFigures:
    said = sides.predictions[number]
    size = size_of_cap(prediction_record(said, sides.image))
    return structs.replace(alone, prediction=said.id, size=size, annotator=sides.marks.annotator)


def _of_pair(sides: Sides, pair: centres.Pair, alone: CapFigures) -> CapFigures:
    matched = structs.replace(alone, prediction=sides.predictions[pair.prediction].id, iou=pair.iou)
    if (error := pair.error) is not None:
        matched = structs.replace(matched, cdr=error.cdr, dx=error.dx, dy=error.dy)
    return _with_mark(matched, sides, pair.truth)


def _with_mark(figures: CapFigures, sides: Sides, number: int) -> CapFigures:
    """Adds which cap it is, whose mark and of what kind, and what that is off by itself."""
    said, record = sides.annotations[number], sides.truths[number]
    of, own = sides.marks.class_of(said, record), floor_of_mark(said, sides.image)
    return structs.replace(
        figures,
        annotation=said.uid,
        floor=sides.marks.hands.floor(of, own),
        own_floor=own,
        annotator=of.annotator,
        size=of.size,
        shape=of.shape,
        visibility=of.visibility,
        doubtful=said.cap.doubtful,
        unsure=is_unsure(said),
        ignored=said.cap.ignored,
    )
