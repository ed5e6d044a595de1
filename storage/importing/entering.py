"""The second half of an import: stores its rows, all within one transaction."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any
from uuid import uuid4

from msgspec import Struct, structs
from sqlalchemy import Connection, Table, insert, select, update

from fairyring.model.geometry.shapes import Fit, polygon_of_shape
from fairyring.storage.change_sets import ChangeSets
from fairyring.storage.db import schema
from fairyring.storage.db.bulk import insert_many
from fairyring.storage.db.clock import now
from fairyring.storage.db.counters import recount
from fairyring.storage.db.numbering import count_on, free_numbers
from fairyring.storage.db.rows import (
    ensure_category,
    load_categories,
    values_of_annotation_fit,
    values_of_cap,
    values_of_fit,
)
from fairyring.storage.formats.found import FoundCap, FoundCategory
from fairyring.storage.images import sort_name
from fairyring.storage.importing.cap_checks import content_number
from fairyring.storage.importing.photos import Photo
from fairyring.storage.predictions import saw
from fairyring.storage.records import Outline
from fairyring.storage.statuses import follow_edits

KeptNumbers = Mapping[str, Collection[int]]
"""Numbers, by table, of what was taken out and may come back."""
CHUNK = 500
"""How many uids are asked for in one statement."""
MOST_ROWS = 5000
"""How many rows are made and added at once."""


class Labelled(Struct, frozen=True, kw_only=True):
    """A photo of the project and the checked caps to enter for it."""

    photo: Photo
    caps: Sequence[FoundCap]


class Entered(Struct, frozen=True, kw_only=True):
    """How many caps were new, and how many were there already."""

    new: int = 0
    known: int = 0


def enter_photos(connection: Connection, photos: Mapping[str, Photo], *, kept: KeptNumbers) -> list[Photo]:
    """Adds images, by their paths; returns them with their ids, which are those of their files where free.

    ``kept``: numbers that are free and stay so.
    """
    wanted = [photo.number for photo in photos.values()]
    numbers = free_numbers(connection, schema.image, wanted, kept=kept.get(schema.image.name, ()))
    # Those with numbers first: the others are counted on from them.
    entered = sorted(zip(photos.items(), numbers, strict=True), key=lambda item: item[1] is None)
    made = [_enter_photo(connection, photo, path=path, number=number) for (path, photo), number in entered]
    count_on(connection, schema.image)
    return made


def _enter_photo(connection: Connection, photo: Photo, *, path: str, number: int | None) -> Photo:
    numbered = {} if number is None else {"id": number}
    statement = insert(schema.image).values(
        **numbered,
        file_name=photo.file_name,
        sort_name=sort_name(photo.file_name),
        path=path,
        width=photo.width,
        height=photo.height,
        sha256=photo.sha256,
        light=photo.light,
        form=photo.form,
        split=photo.split,
        status="new",
        extra=photo.extra,
        added_at=now(),
    )
    own = connection.execute(statement.returning(schema.image.c.id)).scalar_one()
    return structs.replace(photo, id=own, status="new")


def tell_more(connection: Connection, photo: Photo) -> None:
    """Updates an image of the project with what an import says of it."""
    told = {name: getattr(photo, name) for name in ("light", "form", "split", "extra")}
    connection.execute(update(schema.image).where(schema.image.c.id == photo.id).values(**told))


def enter_annotations(
    connection: Connection,
    labelled: Sequence[Labelled],
    *,
    categories: Mapping[str, FoundCategory],
    kept: KeptNumbers,
    user: str,
) -> Entered:
    """Adds annotations and their first journal rows, but for those whose uid is there already."""
    ids = _category_ids(connection, labelled, categories)
    owners = _owners(connection, [cap.uid or "" for item in labelled for cap in item.caps])
    new: list[tuple[Photo, FoundCap, str]] = []
    time, sets, name = now(), ChangeSets(connection, user=user), f"import-{uuid4().hex}"
    numbers: dict[int, int] = {}
    for photo, cap in _pairs(labelled):
        assert photo.id is not None, "photos are entered before their caps"
        uid = _own_number(cap, photo, owners)
        if uid in owners:
            continue
        owners[uid] = photo.id
        numbers[photo.id] = sets.number(photo.id, name, time=time)
        new.append((photo, cap, uid))

    def annotation_of(photo: Photo, cap: FoundCap, uid: str) -> dict[str, Any]:
        return (
            values_of_cap(cap.cap, categories=ids)
            | values_of_annotation_fit(Fit(whole=cap.whole, centre=cap.centre, centre_sd=cap.centre_sd))
            | {"uid": uid, "image": photo.id, "revision": 1, "deleted": False, "extra": cap.extra}
            | {"edited_by": user, "edited_at": time}
        )

    def edit_of(photo: Photo, cap: FoundCap, uid: str) -> dict[str, Any]:
        assert photo.id is not None, "photos are entered before their caps"
        return (
            {"id": f"import-{uid}", "digest": "import", "annotation": uid, "image": photo.id, "base": 0}
            | {"revision": 1, "before": None, "after": cap.cap, "user": user, "made_at": time}
            | {"change_set": numbers[photo.id]}
        )

    wanted = [cap.id for _, cap, _ in new]
    _insert_numbered(connection, schema.annotation, wanted, lambda nth: annotation_of(*new[nth]), kept=kept)
    _insert(connection, schema.edit, (edit_of(*each) for each in new))
    recount(connection, numbers)
    for image, number in numbers.items():
        follow_edits(connection, image, number, takes_back=False, user=user)
    total = sum(len(item.caps) for item in labelled)
    return Entered(new=len(new), known=total - len(new))


def enter_predictions(
    connection: Connection,
    labelled: Sequence[Labelled],
    *,
    categories: Mapping[str, FoundCategory],
    kept: KeptNumbers,
    run_id: int,
) -> Entered:
    """Adds a run's predictions, but for those that it holds already."""
    ids = _category_ids(connection, labelled, categories)
    table = schema.prediction
    present = {
        (image, uid)
        for image, uid in connection.execute(select(table.c.image, table.c.uid).where(table.c.run == run_id))
    }
    new: list[tuple[Photo, FoundCap]] = []
    for photo, cap in _pairs(labelled):
        if (photo.id, cap.uid) not in present:
            present.add((photo.id, cap.uid or ""))
            new.append((photo, cap))

    def row_of(photo: Photo, cap: FoundCap) -> dict[str, Any]:
        # A box alone makes a cap doubtful as a label; only what the file says is kept of a prediction.
        doubted = cap.tells_doubtful and cap.cap.doubtful
        said = {
            key: True for key, holds in (("doubt", doubted), ("marked", cap.cap.mark is not None)) if holds
        }
        return (
            values_of_fit(Fit(whole=cap.whole, centre=cap.centre))
            | {"run": run_id, "image": photo.id, "uid": cap.uid, "category": ids[cap.cap.category]}
            | {"visible": _seen(cap), "score": 1.0 if cap.score is None else cap.score}
            | {"quality": cap.quality, "extra": cap.extra | said}
        )

    wanted = [cap.id for _, cap in new]
    _insert_numbered(connection, table, wanted, lambda nth: row_of(*new[nth]), kept=kept)
    saw(connection, run_id=run_id, image_ids=[item.photo.id for item in labelled if item.photo.id])
    total = sum(len(item.caps) for item in labelled)
    return Entered(new=len(new), known=total - len(new))


def refused_as_prediction(cap: FoundCap) -> str | None:
    """Why a cap of a file cannot be a prediction, if so."""
    if cap.cap.ignored:
        return "It is to be ignored, which a prediction cannot be; it was left out."
    if cap.score is not None and not 0 <= cap.score <= 1:
        return f"Its score of {cap.score:g} does not lie between 0 and 1."
    return None


def _insert_numbered(
    connection: Connection,
    table: Table,
    wanted: Sequence[int | None],
    row_of: Callable[[int], dict[str, Any]],
    *,
    kept: KeptNumbers,
    lowest: int = 1,
) -> None:
    """Adds rows under the ids that their files give them, where these are free.

    ``row_of`` makes the nth of them, without its id.
    """
    numbers = free_numbers(connection, table, wanted, lowest=lowest, kept=kept.get(table.name, ()))
    places = range(len(numbers))
    _insert(
        connection, table, (row_of(nth) | {"id": numbers[nth]} for nth in places if numbers[nth] is not None)
    )
    count_on(connection, table)
    _insert(connection, table, (row_of(nth) for nth in places if numbers[nth] is None))


def _insert(connection: Connection, table: Table, rows: Iterator[dict[str, Any]]) -> None:
    """So many at a time that they are never all in memory."""
    while some := list(islice(rows, MOST_ROWS)):
        insert_many(connection, table, some)


def _pairs(labelled: Iterable[Labelled]) -> Iterator[tuple[Photo, FoundCap]]:
    return ((item.photo, cap) for item in labelled for cap in item.caps)


def _category_ids(
    connection: Connection, labelled: Iterable[Labelled], categories: Mapping[str, FoundCategory]
) -> dict[str, int]:
    """The ids of all categories by name, once those of the files and of their caps are entered."""
    ids = load_categories(connection)
    new = {name: found for name, found in categories.items() if name not in ids}
    rows = [{"name": name, "extra": found.extra} for name, found in new.items()]
    wanted = [found.id for found in new.values()]
    _insert_numbered(connection, schema.category, wanted, rows.__getitem__, kept={}, lowest=0)
    ids = load_categories(connection)
    for name in sorted({cap.cap.category for _, cap in _pairs(labelled)}):
        ensure_category(connection, name, categories=ids)
    return ids


def _owners(connection: Connection, uids: Sequence[str]) -> dict[str, int | None]:
    """The uids among these that are taken, each with the image it belongs to."""
    table = schema.annotation
    owners: dict[str, int | None] = {}
    for start in range(0, len(uids), CHUNK):
        asked = select(table.c.uid, table.c.image).where(table.c.uid.in_(uids[start : start + CHUNK]))
        owners.update({row.uid: row.image for row in connection.execute(asked)})
    return owners


def _own_number(cap: FoundCap, photo: Photo, owners: Mapping[str, int | None]) -> str:
    """The uid from the file, unless a cap in another photo has it."""
    uid = cap.uid or ""
    return uid if owners.get(uid, photo.id) == photo.id else content_number(cap.cap, photo=photo)


def _seen(cap: FoundCap) -> Outline:
    """The visible outline of a prediction; where a file gives only a whole outline, that one."""
    if cap.cap.visible or cap.whole is None:
        return cap.cap.visible
    return [polygon_of_shape(cap.whole)]
