"""How far annotations agree with what a second annotator labelled, which is a run, as comparisons keep it."""

from __future__ import annotations

from msgspec import Struct
from sqlalchemy import Connection, select

from fairyring.model.coco.annotations import is_doubtful
from fairyring.storage.db.comparison_schema import compared_cap, comparison
from fairyring.storage.db.schema import image, prediction


class SecondVersion(Struct, frozen=True, kw_only=True):
    """An image as the annotations and the second version have it."""

    image: int
    file_name: str
    matched: int
    missed: int
    """Caps that the annotations alone have; ``extra`` those of the second version alone."""
    extra: int
    measured: int
    """Pairs whose centres can be compared: where the annotation is marked."""
    iou_mean: float | None
    """Of the pairs."""
    px_mean: float | None
    """Mean distance of the centres, pixels."""
    stale: bool
    """Whether the image was edited since."""


def images_compared(connection: Connection, run_id: int) -> list[SecondVersion]:
    """The images that were compared with this version: those first where most caps have no counterpart, then
    those whose outlines overlap least.
    """
    c = comparison.c
    rows = connection.execute(
        select(
            c.image,
            image.c.file_name,
            *(c.matched, c.missed, c.extra, c.measured, c.iou_mean, c.px_mean),
            (image.c.version != c.version).label("stale"),
        )
        .join(image, image.c.id == c.image)
        .where(c.run == run_id)
        .order_by((c.missed + c.extra).desc(), c.iou_mean.asc().nulls_last(), image.c.sort_name, image.c.id)
    )
    return [SecondVersion(**{**row._asdict(), "stale": bool(row.stale)}) for row in rows]


def doubts(connection: Connection, run_id: int) -> list[tuple[bool, bool]]:
    """Of each cap that both have, whether the annotation and whether the second version is doubtful."""
    rows = connection.execute(
        select(compared_cap.c.doubtful, prediction.c.extra)
        .join(prediction, prediction.c.id == compared_cap.c.prediction)
        .where(compared_cap.c.run == run_id, compared_cap.c.annotation.is_not(None))
    )
    return [(bool(row.doubtful), is_doubtful(row.extra or {})) for row in rows]
