"""Where the annotations of an image and its predictions differ, for those who look at it on the photo."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.caps.records import prediction_record, truth_record
from fairyring.app.caps.repeated import Marks
from fairyring.app.protocol import ComparedCap
from fairyring.model.evaluate.centres import compare
from fairyring.storage.records import Annotation, Image, Prediction

NOBODYS = Marks()


def differences_of(
    image: Image,
    annotations: Sequence[Annotation],
    predictions: Sequence[Prediction],
    marks: Marks = NOBODYS,
) -> list[ComparedCap]:
    """Every cap with the prediction that matches it, those first that a reviewer should look at first.

    Those that have no counterpart come before all others; then those whose CDR passes the floor of their
    mark by most, then those whose outlines overlap least. Ignored caps are left out. Of an image that no
    network has seen there is nothing to say.
    """
    if not predictions:
        return []
    truths = [truth_record(annotation, image) for annotation in annotations]
    guesses = [prediction_record(prediction, image) for prediction in predictions]
    found = compare(truths, guesses, width=image.width, height=image.height)
    matched = [
        ComparedCap(
            annotation=annotations[pair.truth].uid,
            prediction=predictions[pair.prediction],
            iou=pair.iou,
            cdr=pair.error.cdr if pair.error else None,
            floor=marks.floor_of(annotations[pair.truth], truths[pair.truth], image),
        )
        for pair in found.pairs
    ]
    missed = [_alone(annotation=annotations[number].uid) for number in found.missed]
    extra = [_alone(prediction=predictions[number]) for number in found.extra]
    return [*missed, *extra, *sorted(matched, key=_likeness)]


def _alone(*, annotation: str | None = None, prediction: Prediction | None = None) -> ComparedCap:
    return ComparedCap(annotation=annotation, prediction=prediction, iou=None, cdr=None, floor=None)


def _likeness(cap: ComparedCap) -> tuple[float, float]:
    return -max((cap.cdr or 0.0) - (cap.floor or 0.0), 0.0), cap.iou or 0.0
