"""Edits: an append-only journal, revisions, and conflicts instead of lost updates."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256

from msgspec import Struct, json
from sqlalchemy import Connection, insert, select, update

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Fit
from fairyring.storage.cap_validity import check_cap, check_name
from fairyring.storage.db import schema
from fairyring.storage.db.clock import now
from fairyring.storage.db.counters import recount
from fairyring.storage.db.rows import (
    SELECT_ANNOTATIONS,
    annotation_of,
    ensure_category,
    is_number,
    load_categories,
    require_image,
    values_of_cap,
    values_of_fit,
)
from fairyring.storage.errors import StoreError
from fairyring.storage.project import Project
from fairyring.storage.records import Accepted, Annotation, Cap, Conflict, Edit, Outcome, Refused


class Derived(Struct, frozen=True, kw_only=True):
    """An edit with what was worked out from its cap; an empty fit where that is left for later."""

    edit: Edit
    fit: Fit = Fit()


class Entry(Struct, frozen=True, kw_only=True):
    """One row of the journal."""

    id: str
    annotation: str
    image: int
    revision: int
    before: Cap | None
    after: Cap | None
    user: str
    made_at: str
    """UTC, ISO 8601."""


def commit(project: Project, edits: Sequence[Derived], *, user: str) -> list[Outcome]:
    """Stores a change set in one transaction; on disk when this returns.

    Caps are checked and repaired before it begins, so that nobody else waits for that. Each edit has an
    outcome of its own, in order: a conflict or a refusal does not keep the others out.
    An edit sent before is accepted again, with the annotation as it is now.

    Raises:
        StoreError: the database cannot be written, or ``user`` is no name.
    """
    check_name(user, "name of a user")
    try:
        project.require_writable()
    except StoreError as error:
        return [Refused(edit=derived.edit.id, reason=str(error)) for derived in edits]
    checked = _check_caps(project, [derived.edit for derived in edits])
    return project.write(lambda connection: _commit_all(connection, edits, checked, user=user))


def history(connection: Connection, uid: str) -> list[Entry]:
    """All edits of an annotation, the first one first."""
    journal = schema.edit
    statement = select(journal).where(journal.c.annotation == uid).order_by(journal.c.revision)
    return [
        Entry(
            id=row.id,
            annotation=row.annotation,
            image=row.image,
            revision=row.revision,
            before=row.before,
            after=row.after,
            user=row.user,
            made_at=row.made_at,
        )
        for row in connection.execute(statement)
    ]


def digest_of(edit: Edit) -> str:
    """A digest of an edit, to tell one sent twice from another one under the same id."""
    return sha256(json.encode(edit)).hexdigest()


def _check_caps(project: Project, edits: Sequence[Edit]) -> list[Cap | FairyringError | None]:
    """The cap of each edit as it can be stored, or why it cannot; None where the edit has none."""
    checked: list[Cap | FairyringError | None] = []
    with project.read() as connection:
        for edit in edits:
            try:
                checked.append(None if edit.cap is None else _check(connection, edit.cap, edit.image))
            except FairyringError as error:
                checked.append(error)
    return checked


def _check(connection: Connection, cap: Cap, image_id: int) -> Cap:
    photo = require_image(connection, image_id)
    return check_cap(cap, width=photo.width, height=photo.height)


def _commit_all(
    connection: Connection,
    edits: Sequence[Derived],
    checked: Sequence[Cap | FairyringError | None],
    *,
    user: str,
) -> list[Outcome]:
    categories = load_categories(connection)
    outcomes = [
        _commit_one(connection, edit, cap, user=user, categories=categories)
        for edit, cap in zip(edits, checked, strict=True)
    ]
    recount(connection, (o.annotation.image for o in outcomes if isinstance(o, Accepted)))
    return outcomes


def _commit_one(
    connection: Connection,
    derived: Derived,
    checked: Cap | FairyringError | None,
    *,
    user: str,
    categories: dict[str, int],
) -> Outcome:
    edit = derived.edit
    try:
        check_name(edit.id, "number of an edit")
        check_name(edit.annotation, "number of an annotation")
        if (repeated := _sent_before(connection, edit)) is not None:
            return repeated
        current, editor = _current(connection, edit.annotation)
        if current is not None and current.image != edit.image:
            raise StoreError("This annotation belongs to another image.")
        if current is None and edit.base != 0:
            raise StoreError("There is no such annotation; reload the image.")
        if current is not None and not _is_made_on(edit, current):
            return Conflict(edit=edit.id, theirs=current, user=editor)
        cap = _fitting(connection, edit, checked, categories)
    except FairyringError as error:
        return Refused(edit=edit.id, reason=str(error))
    return Accepted(
        edit=edit.id,
        annotation=_store(connection, derived, cap, current, user=user, categories=categories),
    )


def _sent_before(connection: Connection, edit: Edit) -> Outcome | None:
    row = connection.execute(select(schema.edit.c.digest).where(schema.edit.c.id == edit.id)).first()
    if row is None:
        return None
    if row.digest != digest_of(edit):
        raise StoreError("Another edit has this number; reload the page.")
    current, _editor = _current(connection, edit.annotation)
    assert current is not None, "the journal names annotations that exist"
    return Accepted(edit=edit.id, annotation=current)


def _current(connection: Connection, uid: str) -> tuple[Annotation | None, str]:
    statement = SELECT_ANNOTATIONS.where(schema.annotation.c.uid == uid)
    row = connection.execute(statement.with_for_update(of=schema.annotation)).first()
    return (None, "") if row is None else (annotation_of(row), row.edited_by)


def _is_made_on(edit: Edit, current: Annotation) -> bool:
    """Whether an edit was made on the annotation as it is now; only who saw a deletion can undo it."""
    return edit.base == current.revision and not (current.deleted and edit.cap is None)


def _fitting(
    connection: Connection, edit: Edit, checked: Cap | FairyringError | None, categories: dict[str, int]
) -> Cap | None:
    """The checked cap, once it is known to fit what else the project holds."""
    require_image(connection, edit.image)
    if edit.cap is None:
        if edit.base == 0:
            raise StoreError("An annotation that was never made cannot be deleted.")
        return None
    # May be used before anybody has made it; other categories come from imports.
    if edit.cap.category == DEFAULT_CATEGORY:
        ensure_category(connection, DEFAULT_CATEGORY, categories=categories)
    if edit.cap.category not in categories:
        raise StoreError(f"The project has no category “{edit.cap.category}”.")
    if edit.cap.prediction is not None:
        _require_prediction(connection, edit.cap.prediction, image_id=edit.image)
    if isinstance(checked, FairyringError):
        raise checked
    return checked


def _require_prediction(connection: Connection, prediction_id: int, *, image_id: int) -> None:
    table = schema.prediction
    asked = select(table.c.id).where(table.c.id == prediction_id, table.c.image == image_id)
    if not is_number(prediction_id) or connection.execute(asked).first() is None:
        raise StoreError("The prediction this cap started from does not belong to this image.")


def _store(
    connection: Connection,
    derived: Derived,
    cap: Cap | None,
    current: Annotation | None,
    *,
    user: str,
    categories: dict[str, int],
) -> Annotation:
    edit, time = derived.edit, now()
    revision = 1 if current is None else current.revision + 1
    values = {"revision": revision, "deleted": cap is None, "edited_by": user, "edited_at": time}
    if cap is not None:
        values |= values_of_cap(cap, categories=categories)
        values |= values_of_fit(derived.fit)
    table = schema.annotation
    if current is None:
        connection.execute(insert(table).values(uid=edit.annotation, image=edit.image, extra={}, **values))
    else:
        connection.execute(update(table).where(table.c.uid == edit.annotation).values(**values))
    connection.execute(
        insert(schema.edit).values(
            id=edit.id,
            digest=digest_of(edit),
            annotation=edit.annotation,
            image=edit.image,
            base=edit.base,
            revision=revision,
            before=None if current is None or current.deleted else current.cap,
            after=cap,
            user=user,
            made_at=time,
        )
    )
    stored, _editor = _current(connection, edit.annotation)
    assert stored is not None, "it was written just now"
    return stored
