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
from fairyring.storage.records import IMPORT, Annotation, Cap, Edit

Key = TypeVar("Key", str, int)
CHUNK = 500
"""How many rows are asked for in one statement."""


@dataclass(frozen=True)
class MadeBefore:
    """A cap as somebody made it; None where they deleted it."""

    cap: Cap | None
    user: str
    made_at: str


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
    made_before: dict[str, list[MadeBefore]]
    """How the annotations were that take-backs name, the first one first, by uid."""
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
        made = self._made_by(edit, cap) or MadeBefore(cap, user, time)
        values = {"revision": revision, "deleted": cap is None}
        values |= {"edited_by": made.user, "edited_at": made.made_at}
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
        self.annotations[uid], self.digests[edit.id] = after, digest
        self.made_before.setdefault(uid, []).append(made)
        return after

    def _made_by(self, edit: Edit, cap: Cap | None) -> MadeBefore | None:
        """Whose work a cap is that is again what it was; None where nothing is taken back."""
        before = self.made_before.get(edit.annotation, []) if edit.takes_back else []
        return next((each for each in before if each.cap == cap), None)

    def last_editor(self, connection: Connection, uid: str) -> str:
        """Who made the last edit of an annotation, be it to take one back."""
        here = (each["user"] for each in reversed(self._entries) if each["annotation"] == uid)
        stored = select(schema.edit.c.user).where(schema.edit.c.annotation == uid)
        last = stored.order_by(schema.edit.c.revision.desc()).limit(1)
        return next(here, None) or connection.execute(last).scalar_one_or_none() or IMPORT

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
        made_before=_made_before(connection, [each for each in edits if each.takes_back]),
        starters=starters,
        change_sets=ChangeSets(connection, user=user),
    )


def _made_before(connection: Connection, taking_back: Sequence[Edit]) -> dict[str, list[MadeBefore]]:
    edit = schema.edit
    made: dict[str, list[MadeBefore]] = {}
    for uids in chunks(each.annotation for each in taking_back if is_name(each.annotation)):
        asked = select(edit.c.annotation, edit.c.after, edit.c.user, edit.c.made_at)
        for row in connection.execute(asked.where(edit.c.annotation.in_(uids)).order_by(edit.c.revision)):
            made.setdefault(row.annotation, []).append(MadeBefore(row.after, row.user, row.made_at))
    return made


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
