"""Caps as the database holds them: outlines and marks still text, which another process may decode.

To read a row takes a fraction of the time of making a record of it.
"""

from __future__ import annotations

from operator import itemgetter
from typing import Any

import msgspec
from msgspec import UNSET, Struct
from sqlalchemy import Connection, Text, exists, select, type_coerce

from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage.db.columns import Json
from fairyring.storage.db.rows import AnySelect
from fairyring.storage.db.schema import annotation, image, prediction, run
from fairyring.storage.records import Annotation, Cap, Mark, Outline, Prediction, Shape

StoredRow = tuple[Any, ...]


class StoredAnnotation(Struct, frozen=True, array_like=True):
    """A row of ``annotation``, and the prediction it started from."""

    id: int
    uid: str
    revision: int
    visible: str
    mark: str | None
    ignored: bool
    doubtful: bool
    overlap: int | None
    category: int
    whole: str | None
    centre_x: float | None
    centre_y: float | None
    sd_x: float | None
    sd_y: float | None
    extra: str
    edited_by: str
    edited_at: str
    arcs: str | None
    prediction: int | None
    run: str | None
    """Name of the run that made the prediction."""
    score: float | None


class StoredPrediction(Struct, frozen=True, array_like=True):
    """A row of ``prediction``."""

    id: int
    run: int
    category: int
    visible: str
    score: float
    quality: float | None
    whole: str | None
    centre_x: float | None
    centre_y: float | None
    extra: str


def _columns_of(table: Any, names: tuple[str, ...]) -> list[Any]:
    """The columns of these names, JSON as the text it is."""
    columns = (table.c[name] for name in names)
    return [type_coerce(each, Text) if isinstance(each.type, Json) else each for each in columns]


_OF_ANNOTATIONS = StoredAnnotation.__struct_fields__[: -len(("run", "score"))]
_IGNORED = _OF_ANNOTATIONS.index("ignored")
_ANNOTATIONS = (
    select(*_columns_of(annotation, _OF_ANNOTATIONS), run.c.name, prediction.c.score)
    .outerjoin(prediction, prediction.c.id == annotation.c.prediction)
    .outerjoin(run, run.c.id == prediction.c.run)
)
_PREDICTIONS = select(*_columns_of(prediction, StoredPrediction.__struct_fields__))


def stored_annotations(connection: Connection, image_id: int) -> list[StoredRow]:
    """The fields of ``StoredAnnotation`` for the live annotations of an image, as they were made."""
    wanted = annotation.c.image == image_id, annotation.c.deleted == 0
    return _in_order(connection, _ANNOTATIONS.where(*wanted))


def without_ignored(annotations: list[StoredRow]) -> list[StoredRow]:
    """Those of ``stored_annotations`` that are not ignored."""
    return [row for row in annotations if not row[_IGNORED]]


def stored_predictions(
    connection: Connection, image_id: int, *, run_id: int | None = None
) -> list[StoredRow]:
    """The fields of ``StoredPrediction`` for all that a run, else the latest, said of an image."""
    return _in_order(connection, _of_run(image_id, run_id))


def stored_open_predictions(connection: Connection, image_id: int) -> list[StoredRow]:
    """The same for the latest run, without what somebody deleted; of an image that has no annotations."""
    started = exists().where(annotation.c.prediction == prediction.c.id)
    return _in_order(connection, _of_run(image_id, None).where(~started.where(annotation.c.deleted == 1)))


def annotation_of_stored(stored: StoredAnnotation, *, image: int) -> Annotation:
    """The record of a row; what category it has is said by the row's number alone."""
    cap = Cap(
        visible=_OUTLINE.decode(stored.visible),
        mark=None if stored.mark is None else _MARK.decode(stored.mark),
        ignored=stored.ignored,
        doubtful=stored.doubtful,
        order=stored.overlap,
        prediction=stored.prediction,
        arcs=UNSET if stored.arcs is None else _ARCS.decode(stored.arcs),
    )
    return Annotation(
        uid=stored.uid,
        image=image,
        revision=stored.revision,
        cap=cap,
        whole=_whole_of(stored),
        centre=_centre_of(stored),
        centre_sd=None if stored.sd_x is None or stored.sd_y is None else (stored.sd_x, stored.sd_y),
        extra=_KEYS.decode(stored.extra),
    )


def prediction_of_stored(stored: StoredPrediction, *, image: int) -> Prediction:
    """The record of a row; what category it has is said by the row's number alone."""
    return Prediction(
        id=stored.id,
        run=stored.run,
        image=image,
        visible=_OUTLINE.decode(stored.visible),
        score=stored.score,
        quality=stored.quality,
        whole=_whole_of(stored),
        centre=_centre_of(stored),
        extra=_KEYS.decode(stored.extra),
    )


def origin_of(stored: StoredAnnotation) -> dict[str, Any]:
    """Of an annotation: revision, by whom, when, and from which prediction."""
    origin: dict[str, Any] = {
        "revision": stored.revision,
        "edited_by": stored.edited_by,
        "edited_at": stored.edited_at,
    }
    if stored.prediction is not None:
        origin["prediction"] = {"id": stored.prediction, "run": stored.run, "score": stored.score}
    return origin


_OUTLINE = msgspec.json.Decoder(Outline)
_MARK = msgspec.json.Decoder(Mark)
_ARCS = msgspec.json.Decoder(list[ToldArc])
_SHAPE = msgspec.json.Decoder(Shape)
_KEYS = msgspec.json.Decoder(dict[str, Any])


def _whole_of(stored: StoredAnnotation | StoredPrediction) -> Shape | None:
    return None if stored.whole is None else _SHAPE.decode(stored.whole)


def _centre_of(stored: StoredAnnotation | StoredPrediction) -> tuple[float, float] | None:
    x, y = stored.centre_x, stored.centre_y
    return None if x is None or y is None else (x, y)


def _of_run(image_id: int, run_id: int | None) -> AnySelect:
    latest = select(image.c.run).where(image.c.id == image_id).scalar_subquery()
    return _PREDICTIONS.where(
        prediction.c.image == image_id, prediction.c.run == (latest if run_id is None else run_id)
    )


def _in_order(connection: Connection, statement: AnySelect) -> list[StoredRow]:
    # The database would copy whole rows to sort them.
    return sorted((tuple(row) for row in connection.execute(statement)), key=itemgetter(0))
