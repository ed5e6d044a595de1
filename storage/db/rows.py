"""Turns rows into records and back; only this module knows which column holds which field."""

from __future__ import annotations

from typing import Any

from msgspec import UNSET
from sqlalchemy import Connection, Row, Select, func, insert, select

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.db.schema import annotation, category, image, prediction, run
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Annotation, Cap, Image, Prediction, Run

Point = tuple[float, float]
AnyRow = Row[*tuple[Any, ...]]
AnySelect = Select[*tuple[Any, ...]]

SELECT_ANNOTATIONS: AnySelect = select(annotation, category.c.name.label("category_name")).join(
    category, annotation.c.category == category.c.id
)
SELECT_PREDICTIONS: AnySelect = select(prediction, category.c.name.label("category_name")).join(
    category, prediction.c.category == category.c.id
)


def image_of(row: AnyRow) -> Image:
    """The record of a row of ``image``."""
    return Image(
        id=row.id,
        file_name=row.file_name,
        path=row.path,
        width=row.width,
        height=row.height,
        sha256=row.sha256,
        light=row.light,
        form=row.form,
        split=row.split,
        status=row.status,
        statistics=row.statistics,
        extra=row.extra,
    )


def annotation_of(row: AnyRow) -> Annotation:
    """The record of a row of ``SELECT_ANNOTATIONS``."""
    return Annotation(
        uid=row.uid,
        image=row.image,
        revision=row.revision,
        cap=Cap(
            visible=row.visible,
            mark=row.mark,
            ignored=row.ignored,
            doubtful=row.doubtful,
            order=row.overlap,
            category=row.category_name,
            prediction=row.prediction,
            arcs=row.arcs or UNSET,
        ),
        deleted=row.deleted,
        whole=row.whole,
        centre=_centre_of(row),
        centre_sd=None if row.sd_x is None else (row.sd_x, row.sd_y),
        extra=row.extra,
    )


def prediction_of(row: AnyRow) -> Prediction:
    """The record of a row of ``SELECT_PREDICTIONS``."""
    return Prediction(
        id=row.id,
        run=row.run,
        image=row.image,
        visible=row.visible,
        score=row.score,
        quality=row.quality,
        category=row.category_name,
        whole=row.whole,
        centre=_centre_of(row),
        extra=row.extra,
    )


def run_of(row: AnyRow) -> Run:
    """The record of a row of ``run``."""
    return Run(
        id=row.id,
        name=row.name,
        kind=row.kind,
        made_at=row.made_at,
        weights=row.weights,
        settings=row.settings,
    )


def values_of_cap(cap: Cap, *, categories: dict[str, int]) -> dict[str, Any]:
    """The columns of ``annotation`` that a person decides."""
    return {
        "visible": cap.visible,
        "mark": cap.mark,
        "ignored": cap.ignored,
        "doubtful": cap.doubtful,
        "overlap": cap.order,
        "category": categories[cap.category],
        "prediction": cap.prediction,
        "arcs": cap.arcs or None,
    }


def values_of_annotation_fit(fit: Fit) -> dict[str, Any]:
    """The columns of ``annotation`` that are derived."""
    x, y = fit.centre_sd or (None, None)
    return values_of_fit(fit) | {"sd_x": x, "sd_y": y}


def values_of_fit(fit: Fit) -> dict[str, Any]:
    """The columns of ``prediction`` that are derived; of ``annotation`` there are more."""
    x, y = fit.centre or (None, None)
    return {"whole": fit.whole, "centre_x": x, "centre_y": y, "refusal": fit.refusal}


def load_categories(connection: Connection) -> dict[str, int]:
    """The ids of all categories, by name."""
    return {row.name: row.id for row in connection.execute(select(category.c.name, category.c.id))}


def ensure_category(connection: Connection, name: str, *, categories: dict[str, int]) -> int:
    """The id of a category, made if the project lacks it; ``categories`` is kept up to date."""
    if name not in categories:
        result = connection.execute(insert(category).values(name=name, extra={}).returning(category.c.id))
        categories[name] = result.scalar_one()
    return categories[name]


def is_number(value: int) -> bool:
    """Whether this can be the number of a row at all; the database knows no larger ones."""
    return 0 < value < 1 << 31


def require_image(connection: Connection, image_id: int) -> AnyRow:
    """The row of an image.

    Raises:
        StoreError: the project has no such image.
    """
    found = select(image).where(image.c.id == image_id)
    row = connection.execute(found).first() if is_number(image_id) else None
    if row is None:
        raise StoreError(f"The project has no image number {image_id}; reload the list of images.")
    return row


def latest_run_row(connection: Connection) -> AnyRow | None:
    """The row of the run made last; what a second annotator labelled is none."""
    latest = select(func.max(run.c.id)).where(run.c.kind != "second").scalar_subquery()
    return connection.execute(select(run).where(run.c.id == latest)).first()


def _centre_of(row: AnyRow) -> Point | None:
    return None if row.centre_x is None else (row.centre_x, row.centre_y)
