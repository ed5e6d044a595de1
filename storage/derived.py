"""Finds caps whose whole outline is not worked out yet, and stores it once it is."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct
from sqlalchemy import Connection, and_, select, union, update

from fairyring.storage.db.counters import recount
from fairyring.storage.db.rows import values_of_fit
from fairyring.storage.db.schema import annotation, image, prediction
from fairyring.storage.records import Shape


class Fit(Struct, frozen=True, kw_only=True):
    """What was worked out for one cap: a whole outline and its centre, or why there is none."""

    whole: Shape | None = None
    centre: tuple[float, float] | None = None
    refusal: str | None = None


class AnnotationFit(Struct, frozen=True, kw_only=True):
    """For one revision of an annotation."""

    uid: str
    revision: int
    fit: Fit


class PredictionFit(Struct, frozen=True, kw_only=True):
    """For a prediction."""

    id: int
    fit: Fit


class Underived(Struct, frozen=True, kw_only=True):
    """The caps of an image whose whole outline is not worked out yet."""

    annotations: list[str]
    """Uids of live annotations."""
    predictions: list[int]
    """Ids of predictions of the latest run that saw the image."""


_ANNOTATION_LACKS = and_(
    annotation.c.whole.is_(None), annotation.c.refusal.is_(None), annotation.c.deleted == 0
)
_PREDICTION_LACKS = and_(prediction.c.whole.is_(None), prediction.c.refusal.is_(None))


def images_with_underived(connection: Connection) -> list[int]:
    """Ids of the images with such caps."""
    of_latest_run = and_(image.c.id == prediction.c.image, image.c.run == prediction.c.run)
    statement = union(
        select(annotation.c.image).where(_ANNOTATION_LACKS),
        select(prediction.c.image).join(image, of_latest_run).where(_PREDICTION_LACKS),
    )
    return sorted(connection.execute(statement).scalars())


def underived_of(connection: Connection, image_id: int) -> Underived:
    """The caps of one image that lack a whole outline."""
    latest = select(image.c.run).where(image.c.id == image_id).scalar_subquery()
    annotations = select(annotation.c.uid).where(annotation.c.image == image_id, _ANNOTATION_LACKS)
    predictions = select(prediction.c.id).where(
        prediction.c.image == image_id, prediction.c.run == latest, _PREDICTION_LACKS
    )
    return Underived(
        annotations=list(connection.execute(annotations.order_by(annotation.c.id)).scalars()),
        predictions=list(connection.execute(predictions.order_by(prediction.c.id)).scalars()),
    )


def store_derived(
    connection: Connection,
    image_id: int,
    *,
    annotations: Sequence[AnnotationFit] = (),
    predictions: Sequence[PredictionFit] = (),
) -> int:
    """Stores fits of one image where they are still lacking, and returns how many were.

    A fit of an annotation that has been edited since is dropped; the prediction's outline and score stay.
    """
    stored = 0
    for item in annotations:
        statement = update(annotation).where(
            annotation.c.uid == item.uid,
            annotation.c.image == image_id,
            annotation.c.revision == item.revision,
            _ANNOTATION_LACKS,
        )
        stored += connection.execute(statement.values(**_values(item.fit))).rowcount
    for item in predictions:
        statement = update(prediction).where(
            prediction.c.id == item.id, prediction.c.image == image_id, _PREDICTION_LACKS
        )
        stored += connection.execute(statement.values(**_values(item.fit))).rowcount
    if stored:
        recount(connection, [image_id])
    return stored


def _values(fit: Fit) -> dict[str, object]:
    missing = "no outline was found" if fit.whole is None else None
    return values_of_fit(fit.whole, fit.centre, fit.refusal or missing)
