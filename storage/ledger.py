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
from fairyring.storage.change_sets import ChangeSets
from fairyring.storage.db import schema
from fairyring.storage.db.bulk import insert_many, update_many
from fairyring.storage.db.clock import now
from fairyring.storage.db.rows import (
    SELECT_ANNOTATIONS,
    annotation_of,
    is_number,
    load_categories,
    values_of_annotation_fit,
    values_of_cap,
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
    starters: dict[int, set[str]]
    """The uids of the annotations that started from each of the predictions named."""
    change_sets: ChangeSets
    _made: dict[str, dict[str, Any]] = field(default_factory=dict)
    _changed: dict[str, dict[str, Any]] = field(default_factory=dict)
    _entries: list[dict[str, Any]] = field(default_factory=list)
    _sets: dict[tuple[int, int], bool] = field(default_factory=dict)

    def record(self, edit: Edit, cap: Cap | None, fit: Fit, *, digest: str, user: str) -> Annotation:
        """Notes an edit that can be stored, with its checked cap; returns the annotation as it is then."""
        before, time, uid = self.annotations.get(edit.annotation), now(), edit.annotation
        revision = 1 if before is None else before.revision + 1
        values = {"revision": revision, "deleted": cap is None, "edited_by": user, "edited_at": time}
        if cap is not None:
            values |= values_of_cap(cap, categories=self.categories) | values_of_annotation_fit(fit)
        if before is None:
            self._made[uid] = {"uid": uid, "image": edit.image, "extra": {}} | values
        elif uid in self._made:
            self._made[uid] |= values
        else:
            self._changed[uid] = self._changed.get(uid, {}) | values
        number = self.change_sets.number_of(edit, time=time)
        self._sets[edit.image, number] = edit.takes_back != ""
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
                "change_set": number,
            }
        )
        if cap is not None and cap.prediction is not None:
            self.starters.setdefault(cap.prediction, set()).add(uid)
        after = _after(edit, before, cap, fit, revision=revision)
        self.annotations[uid], self.editors[uid], self.digests[edit.id] = after, user, digest
        return after

    def holder_of(self, prediction: int, *, besides: str) -> Annotation | None:
        """Another annotation that has taken this prediction up or turned it down; a live one first."""
        uids = self.starters.get(prediction, set()) - {besides}
        holders = [self.annotations[uid] for uid in sorted(uids)]
        held = [each for each in holders if each.cap.prediction == prediction]
        return min(held, key=lambda each: each.deleted, default=None)

    def write(self, connection: Connection) -> dict[tuple[int, int], bool]:
        """Stores what was recorded.

        Returns the images with the change sets that edits of theirs went into, and whether those take back.
        """
        insert_many(connection, schema.annotation, list(self._made.values()))
        update_many(connection, schema.annotation, schema.annotation.c.uid, self._changed)
        insert_many(connection, schema.edit, self._entries)
        return self._sets


def open_ledger(connection: Connection, edits: Sequence[Edit], *, user: str) -> Ledger:
    """Reads what these edits name, and keeps others from changing those annotations until the end."""
    image, annotation, prediction = schema.image, schema.annotation, schema.prediction
    named = [each.cap.prediction for each in edits if each.cap is not None]
    numbers = [number for number in named if number is not None and is_number(number)]
    asked = [
        *(
            annotation.c.uid.in_(uids)
            for uids in chunks(e.annotation for e in edits if is_name(e.annotation))
        ),
        *(annotation.c.prediction.in_(ids) for ids in chunks(numbers)),
    ]
    rows = {
        row.uid: row
        for which in asked
        for row in connection.execute(SELECT_ANNOTATIONS.where(which).with_for_update(of=annotation))
    }.values()
    starters: dict[int, set[str]] = {}
    for row in rows:
        if row.prediction is not None:
            starters.setdefault(row.prediction, set()).add(row.uid)
    return Ledger(
        categories=load_categories(connection),
        images={
            number
            for ids in chunks(each.image for each in edits if is_number(each.image))
            for number in connection.execute(select(image.c.id).where(image.c.id.in_(ids))).scalars()
        },
        predictions={
            (row.id, row.image)
            for ids in chunks(numbers)
            for row in connection.execute(
                select(prediction.c.id, prediction.c.image).where(prediction.c.id.in_(ids))
            )
        },
        digests=stored_digests(connection, edits),
        annotations={row.uid: annotation_of(row) for row in rows},
        editors={row.uid: row.edited_by for row in rows},
        starters=starters,
        change_sets=ChangeSets(connection, user=user),
    )


def stored_digests(connection: Connection, edits: Sequence[Edit]) -> dict[str, str]:
    """The digests of those of these edits that are stored, by edit id."""
    edit = schema.edit
    return {
        row.id: row.digest
        for ids in chunks(each.id for each in edits if is_name(each.id))
        for row in connection.execute(select(edit.c.id, edit.c.digest).where(edit.c.id.in_(ids)))
    }


def stored_annotations(connection: Connection, named: Iterable[str]) -> dict[str, Annotation]:
    """The annotations of these uids, by uid; deleted ones too."""
    return {
        row.uid: annotation_of(row)
        for uids in chunks(uid for uid in named if is_name(uid))
        for row in connection.execute(SELECT_ANNOTATIONS.where(schema.annotation.c.uid.in_(uids)))
    }


def chunks(keys: Iterable[Key]) -> Iterator[list[Key]]:
    """The different ones of these keys, so many at a time as one statement asks for."""
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
        centre_sd=fit.centre_sd,
        extra={} if before is None else before.extra,
    )
