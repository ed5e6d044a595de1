"""What two people labelled in one photo: the annotations, and another version that was imported as a run."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import Connection

from fairyring.app.review.reviewed import reviewed_images
from fairyring.model.coco.annotations import is_doubtful
from fairyring.model.evaluate.agreement import Agreement, Both, Side, Versions, agreement_of
from fairyring.model.evaluate.centres import compare
from fairyring.storage.records import Annotation, Prediction, Run


def agreement_on_image(connection: Connection, image_id: int, second: Run) -> Agreement:
    """How far the annotations of an image agree with the version of somebody else.

    Annotations to be ignored, and what the second version has there, are left out: such caps are not
    imported as predictions. Centres are compared where the first has a mark.

    Raises:
        StoreError: the project has no such image.
    """
    (found,) = reviewed_images(connection, [image_id], run=second)
    page = found.page
    compared = compare(page.truths, page.predictions, width=page.width, height=page.height)
    ours, theirs = _first_sides(found.annotations), _second_sides(found.predictions)
    return agreement_of(
        Versions(
            pages=[page],
            both=[
                Both(page=0, first=ours[pair.truth], second=theirs[pair.prediction], pair=pair)
                for pair in compared.pairs
            ],
            only_first=[(0, ours[number]) for number in compared.missed],
            only_second=[(0, theirs[number]) for number in compared.extra],
        )
    )


def _first_sides(annotations: Sequence[Annotation]) -> list[Side]:
    return [Side(entry={}, ignored=each.cap.ignored, doubtful=each.cap.doubtful) for each in annotations]


def _second_sides(predictions: Sequence[Prediction]) -> list[Side]:
    return [Side(entry={}, ignored=False, doubtful=is_doubtful(each.extra)) for each in predictions]
