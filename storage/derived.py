"""Finds caps whose whole outline is not worked out yet, and stores it once it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from msgspec import Struct
from sqlalchemy import Connection, and_, bindparam, func, select, union, update

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.db.counters import recount
from fairyring.storage.db.rows import values_of_annotation_fit, values_of_fit
from fairyring.storage.db.schema import annotation, prediction

NONE: Mapping[Any, Fit] = MappingProxyType({})


class Underived(Struct, frozen=True, kw_only=True):
    """The caps of an image whose whole outline is not worked out yet."""

    annotations: list[str]
    """Uids of live annotations."""
    predictions: dict[int, list[int]]
    """Ids of predictions, by run in the order of the runs."""


_ANNOTATION_LACKS = and_(
    annotation.c.whole.is_(None), annotation.c.refusal.is_(None), annotation.c.deleted == 0
)
_PREDICTION_LACKS = and_(prediction.c.whole.is_(None), prediction.c.refusal.is_(None))


_STORE_ANNOTATION = (
    update(annotation)
    .where(
        annotation.c.uid == bindparam("which"),
        annotation.c.image == bindparam("of_image"),
        annotation.c.revision == bindparam("known"),
        _ANNOTATION_LACKS,
    )
    .values({name: bindparam(name) for name in values_of_annotation_fit(Fit())})
)
_STORE_PREDICTION = (
    update(prediction)
    .where(
        prediction.c.id == bindparam("which"),
        prediction.c.image == bindparam("of_image"),
        _PREDICTION_LACKS,
    )
    .values({name: bindparam(name) for name in values_of_fit(Fit())})
)


def images_with_underived(connection: Connection, image_ids: Iterable[int] | None = None) -> list[int]:
    """Ids of the images with such caps, of all or among those named."""
    annotations = select(annotation.c.image).where(_ANNOTATION_LACKS)
    predictions = select(prediction.c.image).where(_PREDICTION_LACKS)
    if image_ids is None:
        return sorted(connection.execute(union(annotations, predictions)).scalars())
    found: set[int] = set()
    for one in image_ids:
        of_one = union(
            annotations.where(annotation.c.image == one), predictions.where(prediction.c.image == one)
        )
        found.update(connection.execute(of_one).scalars())
    return sorted(found)


def count_underived(connection: Connection) -> int:
    """How many caps and predictions lack a whole outline."""
    counts = [
        connection.execute(select(func.count()).select_from(table).where(lacks)).scalar_one()
        for table, lacks in ((annotation, _ANNOTATION_LACKS), (prediction, _PREDICTION_LACKS))
    ]
    return sum(counts)


def underived_of(connection: Connection, image_id: int) -> Underived:
    """The caps of one image that lack a whole outline."""
    annotations = select(annotation.c.uid).where(annotation.c.image == image_id, _ANNOTATION_LACKS)
    predictions = select(prediction.c.run, prediction.c.id).where(
        prediction.c.image == image_id, _PREDICTION_LACKS
    )
    of_runs: dict[int, list[int]] = {}
    for row in connection.execute(predictions.order_by(prediction.c.run, prediction.c.id)):
        of_runs.setdefault(row.run, []).append(row.id)
    return Underived(
        annotations=list(connection.execute(annotations.order_by(annotation.c.id)).scalars()),
        predictions=of_runs,
    )


def store_derived(
    connection: Connection,
    image_id: int,
    *,
    annotations: Mapping[tuple[str, int], Fit] = NONE,
    predictions: Mapping[int, Fit] = NONE,
) -> int:
    """Stores fits of one image where they are still lacking, and returns how many were.

    ``annotations`` are named by uid and revision: the fit of one that has been edited since is dropped.
    ``predictions`` are named by id; their outlines and scores stay.
    """
    of_annotations = [
        {"which": uid, "known": revision, "of_image": image_id} | values_of_annotation_fit(_or_refused(fit))
        for (uid, revision), fit in annotations.items()
    ]
    of_predictions = [
        {"which": number, "of_image": image_id} | values_of_fit(_or_refused(fit))
        for number, fit in predictions.items()
    ]
    stored = 0
    if of_annotations:
        stored += connection.execute(_STORE_ANNOTATION, of_annotations).rowcount
    if of_predictions:
        stored += connection.execute(_STORE_PREDICTION, of_predictions).rowcount
    if stored:
        recount(connection, [image_id])
    return stored


def _or_refused(fit: Fit) -> Fit:
    """A fit that will not be asked for again."""
    lacks = fit.whole is None and fit.refusal is None
    return Fit(refusal="no outline was found") if lacks else fit
