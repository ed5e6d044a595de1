"""Two runs on the images that both were compared on: their figures, and the caps that changed most."""

from __future__ import annotations

from msgspec import Struct
from sqlalchemy import Connection, func, select

from fairyring.storage.db.comparison_schema import compared_cap, comparison
from fairyring.storage.db.schema import image
from fairyring.storage.images_seen import images_seen
from fairyring.storage.review_figures import Totals, totals_among


class BothRuns(Struct, frozen=True, kw_only=True):
    """Two runs side by side."""

    images: int
    """How many images both were compared on."""
    first: Totals
    second: Totals


class ChangedCap(Struct, frozen=True, kw_only=True):
    """A cap whose centre the two runs put at places of different CDR, percent."""

    image: int
    file_name: str
    annotation: str
    before: float
    after: float
    floor: float | None


def both_runs(connection: Connection, first: int, second: int) -> BothRuns:
    """The figures of two runs on the images that both were compared on."""
    of_second = select(comparison.c.image).where(comparison.c.run == second)
    common = select(comparison.c.image).where(comparison.c.run == first, comparison.c.image.in_(of_second))
    images = connection.execute(select(func.count()).select_from(common.subquery())).scalar_one()
    return BothRuns(
        images=images,
        first=totals_among(connection, first, common),
        second=totals_among(connection, second, common),
    )


def changed_caps(connection: Connection, first: int, second: int, *, limit: int = 12) -> list[ChangedCap]:
    """The caps whose CDR changed most from the first run to the second."""
    before, after = compared_cap.alias(), compared_cap.alias()
    change = func.abs(after.c.cdr - before.c.cdr)
    rows = connection.execute(
        select(
            before.c.image,
            image.c.file_name,
            before.c.annotation,
            before.c.cdr.label("before"),
            after.c.cdr.label("after"),
            after.c.floor,
        )
        .join(after, (after.c.image == before.c.image) & (after.c.annotation == before.c.annotation))
        .join(image, image.c.id == before.c.image)
        .where(
            before.c.run == first,
            after.c.run == second,
            before.c.cdr.is_not(None),
            after.c.cdr.is_not(None),
            change > 0,
        )
        .order_by(change.desc(), image.c.sort_name, before.c.sequence)
        .limit(limit)
    )
    return [ChangedCap(**row._asdict()) for row in rows]


def lacking_comparison(connection: Connection, run_id: int) -> list[int]:
    """Images with caps that this run saw, whose figures against it are missing or out of date."""
    statement = (
        select(image.c.id)
        .outerjoin(comparison, (comparison.c.image == image.c.id) & (comparison.c.run == run_id))
        .where(
            image.c.id.in_(images_seen(connection, run_id)),
            image.c.caps + image.c.ignored > 0,
            comparison.c.version.is_(None) | (comparison.c.version != image.c.version),
        )
        .order_by(image.c.id)
    )
    return list(connection.execute(statement).scalars())
