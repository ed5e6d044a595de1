"""Reads what is on one image: for the editor, an export and a comparison."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Connection, exists, select

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.storage.db.rows import (
    SELECT_ANNOTATIONS,
    SELECT_PREDICTIONS,
    AnySelect,
    annotation_of,
    image_of,
    is_number,
    prediction_of,
    require_image,
    run_of,
)
from fairyring.storage.db.schema import annotation, image, prediction, run
from fairyring.storage.open_predictions import offered
from fairyring.storage.records import IMPORT, Annotation, ImageContents, Outline, Prediction, Run


def load_contents(connection: Connection, image_id: int) -> ImageContents:
    """The contents of an image: live annotations, and predictions that are open or became one of them.

    Predictions that somebody deleted, or that lie on a cap people have labelled already, are left out.

    Raises:
        StoreError: the project has no such image.
    """
    row = require_image(connection, image_id)
    photo, annotations = image_of(row), load_annotations(connection, image_id)
    predictions = _predictions(connection, _of_latest_run(image_id).where(~_rejected()))
    return ImageContents(
        image=photo,
        annotations=annotations,
        predictions=offered(photo, annotations, predictions),
        run=None if row.run is None else load_run(connection, row.run),
        unchecked=_unchecked(connection, image_id),
        likely=_likely(connection, image_id),
    )


def _likely(connection: Connection, image_id: int) -> list[tuple[Outline, LikelyEllipse]]:
    became = select(annotation.c.prediction).where(annotation.c.image == image_id, annotation.c.deleted == 0)
    latest = select(image.c.run).where(image.c.id == image_id).scalar_subquery()
    statement = select(prediction.c.visible, prediction.c.likely_whole).where(
        prediction.c.image == image_id,
        prediction.c.likely_whole.is_not(None),
        (prediction.c.run == latest) | prediction.c.id.in_(became),
    )
    return [(row.visible, row.likely_whole) for row in connection.execute(statement)]


def _unchecked(connection: Connection, image_id: int) -> list[str]:
    untouched = (annotation.c.image == image_id, annotation.c.deleted == 0, annotation.c.edited_by == IMPORT)
    return list(connection.execute(select(annotation.c.uid).where(*untouched)).scalars())


def load_annotations(connection: Connection, image_id: int) -> list[Annotation]:
    """The live annotations of an image, in the order in which they were made."""
    statement = (
        SELECT_ANNOTATIONS.where(annotation.c.image == image_id, annotation.c.deleted == 0)
        .order_by(annotation.c.id)
    )  # fmt: skip
    return [annotation_of(row) for row in connection.execute(statement)]


def load_turned_down(connection: Connection, image_id: int) -> list[Annotation]:
    """The deleted annotations of an image that say of a prediction that it is no cap."""
    statement = SELECT_ANNOTATIONS.where(
        annotation.c.image == image_id, annotation.c.deleted == 1, annotation.c.prediction.is_not(None)
    )
    return [annotation_of(row) for row in connection.execute(statement.order_by(annotation.c.id))]


def load_annotation(connection: Connection, uid: str) -> Annotation | None:
    """One annotation, also where it was deleted."""
    row = connection.execute(SELECT_ANNOTATIONS.where(annotation.c.uid == uid)).one_or_none()
    return None if row is None else annotation_of(row)


def load_editors(connection: Connection, image_id: int) -> dict[str, str]:
    """Who edited each live annotation of an image last, by uid."""
    statement = select(annotation.c.uid, annotation.c.edited_by).where(
        annotation.c.image == image_id, annotation.c.deleted == 0
    )
    return {row.uid: row.edited_by for row in connection.execute(statement)}


def load_predictions(connection: Connection, image_id: int) -> list[Prediction]:
    """All predictions of the latest run that saw an image, deleted or accepted ones too."""
    return _predictions(connection, _of_latest_run(image_id))


def load_prediction(connection: Connection, prediction_id: int) -> Prediction | None:
    """One prediction of any run."""
    found = SELECT_PREDICTIONS.where(prediction.c.id == prediction_id)
    row = connection.execute(found).first() if is_number(prediction_id) else None
    return None if row is None else prediction_of(row)


def load_run(connection: Connection, run_id: int) -> Run | None:
    """One run."""
    row = connection.execute(select(run).where(run.c.id == run_id)).first()
    return None if row is None else run_of(row)


def load_latest_run(connection: Connection, image_id: int) -> Run | None:
    """The latest run that saw an image. Raises StoreError where the project has no such image."""
    latest = require_image(connection, image_id).run
    return None if latest is None else load_run(connection, latest)


def load_version(connection: Connection, image_id: int) -> int:
    """The image's version, which grows whenever an annotation or prediction of it changes.

    Read it before the caps that a figure is computed from, and store it with the figure.

    Raises:
        StoreError: the project has no such image.
    """
    return require_image(connection, image_id).version


def _of_latest_run(image_id: int) -> AnySelect:
    latest = select(image.c.run).where(image.c.id == image_id).scalar_subquery()
    return SELECT_PREDICTIONS.where(prediction.c.image == image_id, prediction.c.run == latest)


def _rejected() -> Any:
    """A prediction that somebody turned into a deleted annotation, and not into a live one."""
    started = exists().where(annotation.c.prediction == prediction.c.id)
    return started.where(annotation.c.deleted == 1) & ~started.where(annotation.c.deleted == 0)


def _predictions(connection: Connection, statement: AnySelect) -> list[Prediction]:
    return [prediction_of(row) for row in connection.execute(statement.order_by(prediction.c.id))]
