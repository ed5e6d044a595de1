"""The list of images: filtered, sorted, a page at a time, and the position of one image in it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Literal

from msgspec import Struct
from sqlalchemy import ColumnElement, Connection, and_, case, func, or_, select, update

from fairyring.model.light_and_form import FORMS, LIGHTS
from fairyring.storage.db.comparison_schema import comparison
from fairyring.storage.db.rows import AnyRow, AnySelect, image_of, require_image
from fairyring.storage.db.schema import image, prediction, verdict
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Image, Says, Status

Sort = Literal["name", "added", "caps", "cdr", "gain"]
"""`gain`: where a look is worth most, image by image of every light and form in turn."""

LAST = 10**9
"""After every image that there is still something to do on."""


class ImageFilter(Struct, frozen=True, kw_only=True):
    """Which images, in which order. None asks for nothing."""

    search: str = ""
    """Part of the file name, upper or lower case."""
    status: Status | None = None
    given_back: Says | None = None
    """Last rejected, or last sent back, and to do since."""
    light: str | None = None
    form: str | None = None
    split: str | None = None
    """An empty one finds images that are in none."""
    predicted: bool | None = None
    """Has predictions (True) or has none."""
    annotated: bool | None = None
    """Has live annotations (True) or has none."""
    sort: Sort = "name"
    descending: bool = False
    """Images without a figure come last either way."""


class ImageRow(Struct, frozen=True, kw_only=True):
    """One line of the image list."""

    image: Image
    caps: int
    """Live annotations that are not ignored."""
    ignored: int
    predicted: int
    """Predictions of the latest run that saw the image."""
    cdr_mean: float | None
    """Mean CDR of the latest comparison, percent; it may be out of date."""
    floor_mean: float | None
    """Mean CDR, percent, that its marks have by themselves."""
    cdr_worst: float | None
    worst: str | None
    """Uid of the annotation with the worst CDR."""


class ImagePage(Struct, frozen=True, kw_only=True):
    """One page of the image list, and how many images the filter finds in all."""

    rows: list[ImageRow]
    total: int


class ListPosition(Struct, frozen=True, kw_only=True):
    """Where an image stands in the list. One that the filter leaves out stands where it would be."""

    position: int
    """Position in the list, from 0."""
    count: int
    """How many images the filter finds."""
    previous: int | None
    next: int | None


def list_images(connection: Connection, which: ImageFilter, *, offset: int = 0, limit: int = 50) -> ImagePage:
    """A page of the list and the length of the whole."""
    # The page is cut from bare numbers: SQLite would otherwise join and read every row it skips.
    ids = list(connection.execute(_ordered(which, _condition(which)).offset(offset).limit(limit)).scalars())
    latest = and_(comparison.c.image == image.c.id, comparison.c.run == image.c.run)
    found: AnySelect = (
        select(
            image, comparison.c.cdr_mean, comparison.c.floor_mean, comparison.c.cdr_worst, comparison.c.worst
        )
        .select_from(image.outerjoin(comparison, latest))
        .where(image.c.id.in_(ids))
    )
    rows = {row.id: _row(row) for row in connection.execute(found)}
    total = connection.execute(select(func.count()).select_from(image).where(_condition(which)))
    return ImagePage(rows=[rows[each] for each in ids], total=total.scalar_one())


def splits_of(connection: Connection, which: ImageFilter) -> dict[str | None, int]:
    """How many of the images that the filter finds are in each split, None for none."""
    statement = select(image.c.split, func.count()).where(_condition(which)).group_by(image.c.split)
    return {row[0]: row[1] for row in connection.execute(statement.order_by(image.c.split.nulls_last()))}


def list_ids(connection: Connection, which: ImageFilter) -> list[int]:
    """The numbers of all images the filter finds, in its order."""
    return list(connection.execute(_ordered(which, _condition(which))).scalars())


def position_in_list(connection: Connection, which: ImageFilter, image_id: int) -> ListPosition:
    """Where the image stands, and its neighbours; by gain those that it had while it was to do.

    What is done goes to the end there, and whoever has just said so goes on to the next, not to the end.

    Raises:
        StoreError: the project has no such image.
    """
    require_image(connection, image_id)
    condition = _condition(which)
    listed = or_(condition, image.c.id == image_id)
    ids = list(connection.execute(_ordered(which, listed)).scalars())
    position = ids.index(image_id)
    walked = ids
    if which.sort == "gain":
        walked = list(connection.execute(_ordered(which, listed, here=image_id)).scalars())
    at = walked.index(image_id)
    found = connection.execute(select(image.c.id).where(image.c.id == image_id, condition)).first()
    return ListPosition(
        position=position,
        count=len(ids) if found else len(ids) - 1,
        previous=walked[at - 1] if at else None,
        next=walked[at + 1] if at + 1 < len(walked) else None,
    )


def get_image(connection: Connection, image_id: int) -> Image:
    """One image.

    Raises:
        StoreError: the project has no such image.
    """
    return image_of(require_image(connection, image_id))


def find_image(connection: Connection, file_name: str) -> Image | None:
    """The image of this base name; None where there is none."""
    row = connection.execute(select(image).where(image.c.file_name == file_name)).first()
    return None if row is None else image_of(row)


def set_light_and_form(
    connection: Connection, image_id: int, *, light: str | None, form: str | None
) -> Image:
    """Says by which light an image was taken and which form its caps have; None for not known.

    Raises:
        StoreError: the project has no such image, or there is no such light or form.
    """
    require_image(connection, image_id)
    for word, known in ((light, LIGHTS), (form, FORMS)):
        if word is not None and word not in known:
            raise StoreError(f"{word!r} is none of {', '.join(known)}.")
    connection.execute(update(image).where(image.c.id == image_id).values(light=light, form=form))
    return get_image(connection, image_id)


def keep_statistics(connection: Connection, image_id: int, statistics: Mapping[str, float]) -> None:
    """Stores what was measured on the masks of an image."""
    connection.execute(update(image).where(image.c.id == image_id).values(statistics=dict(statistics)))


def sort_name(file_name: str) -> str:
    """The key to sort a name by: bed_2 comes before bed_10, upper case beside lower case."""
    return re.sub(r"[0-9]+", lambda digits: digits.group().zfill(12), file_name.casefold())


def _ordered(which: ImageFilter, condition: ColumnElement[bool], *, here: int | None = None) -> AnySelect:
    """The numbers of images, in order; by gain the one ``here`` stands as if it were still to do."""
    images = image
    if which.sort == "cdr":
        latest = and_(comparison.c.image == image.c.id, comparison.c.run == image.c.run)
        images = image.outerjoin(comparison, latest)
    return select(image.c.id).select_from(images).where(condition).order_by(*_order(which, here))


def _condition(which: ImageFilter) -> ColumnElement[bool]:
    wanted: list[ColumnElement[bool]] = [
        image.c[name] == value
        for name in ("status", "light", "form")
        if (value := getattr(which, name)) is not None
    ]
    if which.split is not None:
        wanted.append(image.c.split == which.split if which.split else image.c.split.is_(None))
    if which.search:
        wanted.append(image.c.file_name.icontains(which.search, autoescape=True))
    if which.given_back is not None:
        wanted += [image.c.status == "new", image.c.id.in_(_last_said(which.given_back))]
    if which.predicted is not None:
        wanted.append(image.c.predicted > 0 if which.predicted else image.c.predicted == 0)
    if which.annotated is not None:
        live = image.c.caps + image.c.ignored
        wanted.append(live > 0 if which.annotated else live == 0)
    return and_(image.c.id > 0, *wanted)


def _last_said(says: Says) -> AnySelect:
    """The images of which this was said last, comments aside."""
    of_images = and_(verdict.c.annotation.is_(None), verdict.c.says != "comment")
    last = select(func.max(verdict.c.sequence)).where(of_images).group_by(verdict.c.image)
    return select(verdict.c.image).where(verdict.c.sequence.in_(last), verdict.c.says == says)


def _order(which: ImageFilter, here: int | None) -> list[ColumnElement[Any]]:
    columns: dict[Sort, ColumnElement[Any]] = {
        "name": image.c.sort_name,
        "added": image.c.id,
        "caps": image.c.caps,
        "cdr": comparison.c.cdr_worst,
        "gain": _turn(here),
    }
    column = columns[which.sort]
    directed = column.desc() if which.descending else column.asc()
    if which.sort == "cdr":
        return [directed.nulls_last(), image.c.sort_name, image.c.id]
    if which.sort == "gain":
        return [directed, _gain(here).desc(), image.c.sort_name, image.c.id]
    return [directed, image.c.sort_name, image.c.id]


def _to_do(here: int | None) -> ColumnElement[bool]:
    return or_(image.c.status == "new", image.c.id == here)


def _gain(here: int | None) -> ColumnElement[float]:
    """How many wrong caps to expect, as scores are probabilities; none once an image is done."""
    doubts = select(func.sum(1 - prediction.c.score)).where(
        prediction.c.image == image.c.id, prediction.c.run == image.c.run
    )
    return case((_to_do(here), func.coalesce(doubts.scalar_subquery(), 0.0)), else_=-1.0)


def _turn(here: int | None) -> ColumnElement[int]:
    """First the image of most gain of every light and form, then the second of each, and so on."""
    kind = (image.c.light, image.c.form, case((_to_do(here), 0), else_=1))
    turn = func.row_number().over(partition_by=kind, order_by=(_gain(here).desc(), image.c.id))
    return case((_to_do(here), turn), else_=turn + LAST)


def _row(row: AnyRow) -> ImageRow:
    return ImageRow(
        image=image_of(row),
        caps=row.caps,
        ignored=row.ignored,
        predicted=row.predicted,
        cdr_mean=row.cdr_mean,
        floor_mean=row.floor_mean,
        cdr_worst=row.cdr_worst,
        worst=row.worst,
    )
