"""Images that somebody worked on, as evaluation reads them, straight from the store."""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase

from sqlalchemy import Connection

from fairyring.app.caps.records import prediction_record, truth_record
from fairyring.app.caps.repeated import Marks, hands_known
from fairyring.model.evaluate.pages import Page
from fairyring.storage.contents import load_annotations, load_editors, load_predictions
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.records import Annotation, Image, Prediction, Run
from fairyring.storage.runs import predictions_by


@dataclass(frozen=True, eq=False)
class ReviewedImage:
    """An image with its caps; those of ``page`` are in the same order."""

    image: Image
    annotations: list[Annotation]
    predictions: list[Prediction]
    """Of the run that was asked for, else the latest that saw the image."""
    page: Page
    marks: Marks
    """Whose they are, and how far off these people's marks are."""


def worked_on(
    connection: Connection, *, images: str = "*", among: Container[int] | None = None
) -> tuple[list[Image], list[Image]]:
    """The images that somebody worked on, by name, and all others.

    Somebody worked on an image that has a cap, or of which somebody said that it is done. On any other one
    every prediction would count as extra, though nobody has looked. ``images`` and ``among`` are as for
    ``figures.review_of``.
    """
    with_caps = set(list_ids(connection, ImageFilter(annotated=True)))
    touched, others = [], []
    for number in list_ids(connection, ImageFilter()):
        image = get_image(connection, number)
        if not fnmatchcase(image.file_name, images) or (among is not None and number not in among):
            continue
        if number in with_caps or image.status != "new":
            touched.append(image)
        else:
            others.append(image)
    return touched, others


def reviewed_images(
    connection: Connection, numbers: list[int], *, run: Run | None = None
) -> Iterator[ReviewedImage]:
    """The images of these numbers, one after the other, with the predictions of a run, else the latest."""
    hands = hands_known(connection)
    for number in numbers:
        image = get_image(connection, number)
        annotations = load_annotations(connection, number)
        predictions = predictions_of(connection, number, run=run)
        page = Page(
            file_name=image.file_name,
            width=image.width,
            height=image.height,
            truths=[truth_record(each, image) for each in annotations],
            predictions=[prediction_record(each, image) for each in predictions],
            light=image.light,
            form=image.form,
        )
        marks = Marks(editors=load_editors(connection, number), hands=hands)
        yield ReviewedImage(image, annotations, predictions, page, marks)


def predictions_of(connection: Connection, image_id: int, *, run: Run | None) -> list[Prediction]:
    """What a run said of an image; for None the latest that saw it."""
    if run is None:
        return load_predictions(connection, image_id)
    return predictions_by(connection, run.id, image_id)
