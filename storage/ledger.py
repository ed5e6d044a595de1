"""What a change set must know of the store, read at once, and what it adds to it, written at once.

One by one, each edit would ask the database half a dozen questions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from msgspec import structs
from sqlalchemy import Connection, select

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.cap_validity import is_name
from fairyring.storage.db import schema
from fairyring.storage.db.bulk import insert_many, update_many
from fairyring.storage.db.clock import now
from fairyring.storage.db.rows import (
    SELECT_ANNOTATIONS,
    annotation_of,
    is_number,
    load_categories,
    values_of_cap,
    values_of_fit,
)
from fairyring.storage.records import Annotation, Cap, Edit

Key = TypeVar("Key", str, int)
CHUNK = 500
"""How many rows are asked for in one statement."""


@dataclass(kw_only=True)
class Ledger:
    """The rows that the edits of a change set name, as they are once those recorded so far are stored."""

    categories: dict[str, int]
    """Ids by name."""
    images: Collection[int]
    """The images there are, of those named."""
    predictions: Collection[tuple[int, int]]
    """The predictions there are, of those named, each with its image."""
    digests: dict[str, str]
    """Digests of the stored edits, by edit id."""
    annotations: dict[str, Annotation]
    """By uid; deleted ones too."""
    editors: dict[str, str]
    """Who edited each annotation last, by uid."""
    _made: dict[str, dict[str, Any]] = field(default_factory=dict)
    _changed: dict[str, dict[str, Any]] = field(default_factory=dict)
    _entries: list[dict[str, Any]] = field(default_factory=list)

    def record(self, edit: Edit, cap: Cap | None, fit: Fit, *, digest: str, user: str) -> Annotation:
        """Notes an edit that can be stored, with its checked cap; returns the annotation as it is then."""
        before, time, uid = self.annotations.get(edit.annotation), now(), edit.annotation
        revision = 1 if before is None else before.revision + 1
        values = {"revision": revision, "deleted": cap is None, "edited_by": user, "edited_at": time}
        if cap is not None:
            values |= values_of_cap(cap, categories=self.categories) | values_of_fit(fit)
        if before is None:
            self._made[uid] = {"uid": uid, "image": edit.image, "extra": {}} | values
        elif uid in self._made:
            self._made[uid] |= values
        else:
            self._changed[uid] = self._changed.get(uid, {}) | values
        self._entries.append(
            {
                "id": edit.id,
                "digest": digest,
                "annotation": uid,
                "image": edit.image,
                "base": edit.base,
                "revision": revision,
                "before": None if before is None or before.deleted else before.cap,
                "after": cap,
                "user": user,
                "made_at": time,
            }
        )
        after = _after(edit, before, cap, fit, revision=revision)
        self.annotations[uid], self.editors[uid], self.digests[edit.id] = after, user, digest
        return after

    def write(self, connection: Connection) -> None:
        """Stores what was recorded."""
        insert_many(connection, schema.annotation, list(self._made.values()))
        update_many(connection, schema.annotation, schema.annotation.c.uid, self._changed)
        insert_many(connection, schema.edit, self._entries)


def open_ledger(connection: Connection, edits: Sequence[Edit]) -> Ledger:
    """Reads what these edits name, and keeps others from changing those annotations until the end."""
    image, edit, annotation, prediction = schema.image, schema.edit, schema.annotation, schema.prediction
    rows = [
        row
        for uids in _chunks(each.annotation for each in edits if is_name(each.annotation))
        for row in connection.execute(
            SELECT_ANNOTATIONS.where(annotation.c.uid.in_(uids)).with_for_update(of=annotation)
        )
    ]
    numbers = (each.cap.prediction for each in edits if each.cap is not None)
    return Ledger(
        categories=load_categories(connection),
        images={
            number
            for ids in _chunks(each.image for each in edits if is_number(each.image))
            for number in connection.execute(select(image.c.id).where(image.c.id.in_(ids))).scalars()
        },
        predictions={
            (row.id, row.image)
            for ids in _chunks(number for number in numbers if number is not None and is_number(number))
            for row in connection.execute(
                select(prediction.c.id, prediction.c.image).where(prediction.c.id.in_(ids))
            )
        },
        digests={
            row.id: row.digest
            for ids in _chunks(each.id for each in edits if is_name(each.id))
            for row in connection.execute(select(edit.c.id, edit.c.digest).where(edit.c.id.in_(ids)))
        },
        annotations={row.uid: annotation_of(row) for row in rows},
        editors={row.uid: row.edited_by for row in rows},
    )


def _chunks(keys: Iterable[Key]) -> Iterator[list[Key]]:
    different = list(dict.fromkeys(keys))
    return (different[start : start + CHUNK] for start in range(0, len(different), CHUNK))


def _after(edit: Edit, before: Annotation | None, cap: Cap | None, fit: Fit, *, revision: int) -> Annotation:
    """The annotation as the store has it once the edit is in it."""
    if cap is None:
        assert before is not None, "what was never made cannot be deleted"
        return structs.replace(before, revision=revision, deleted=True)
    return Annotation(
        uid=edit.annotation,
        image=edit.image,
        revision=revision,
        cap=cap,
        whole=fit.whole,
        centre=fit.centre,
        extra={} if before is None else before.extra,
    )
