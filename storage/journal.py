"""Edits: an append-only journal, revisions, and conflicts instead of lost updates."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256

from msgspec import Struct, json
from sqlalchemy import Connection, select

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Fit
from fairyring.storage.cap_validity import check_cap, check_name
from fairyring.storage.change_sets import ChangeSets, check_change_set
from fairyring.storage.db import schema
from fairyring.storage.db.counters import recount
from fairyring.storage.db.rows import AnyRow, ensure_category, require_image
from fairyring.storage.errors import StoreError
from fairyring.storage.judging import commit_verdict
from fairyring.storage.ledger import Ledger, open_ledger, stored_annotations, stored_digests
from fairyring.storage.project import Project
from fairyring.storage.records import (
    Accepted,
    Annotation,
    Cap,
    Conflict,
    Edit,
    Outcome,
    Refused,
    StatusEdit,
    Verdict,
)
from fairyring.storage.statuses import commit_status, follow_edits


class Derived(Struct, frozen=True, kw_only=True):
    """An edit with what was worked out from its cap; an empty fit where that is left for later."""

    edit: Edit
    fit: Fit = Fit()
    checked: Cap | None = None
    """The cap as it can be stored, where `check_cap` was asked already, with the image's size."""
    unfit: str = ""
    """Why it cannot be stored, where `check_cap` said so."""


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


def commit(
    project: Project,
    edits: Sequence[Derived],
    *,
    statuses: Sequence[StatusEdit] = (),
    verdicts: Sequence[Verdict] = (),
    user: str,
) -> list[Outcome]:
    """Stores a change set, or a piece of one, in one transaction; on disk when this returns.

    Caps are checked and repaired before it begins, so that nobody else waits for that. Each edit has an
    outcome of its own, in order, then those of ``statuses`` and of ``verdicts``: a conflict or a refusal does
    not keep the others out. An edit sent before is accepted again, with the annotation as it is now.

    Raises:
        StoreError: the database cannot be written, or ``user`` is no name.
    """
    check_name(user, "name of a user")
    try:
        project.require_writable()
    except StoreError as error:
        numbers = [each.id for each in [*(derived.edit for derived in edits), *statuses, *verdicts]]
        return [Refused(edit=number, reason=str(error)) for number in numbers]
    if not edits and not statuses and not verdicts:
        return []
    checked = _check_caps(project, edits)

    def work(connection: Connection) -> list[Outcome]:
        outcomes = _commit_all(connection, edits, checked, user=user)
        sets = ChangeSets(connection, user=user)
        outcomes += [commit_status(connection, made, sets, user=user) for made in statuses]
        return outcomes + [commit_verdict(connection, said, sets, user=user) for said in verdicts]

    return project.write(work)


def known_outcomes(connection: Connection, edits: Sequence[Edit]) -> dict[str, Accepted]:
    """What was answered to those of these edits that are stored already, by edit id.

    So an edit that is sent again costs no more than a look.
    """
    known = stored_digests(connection, edits)
    again = [edit for edit in edits if known.get(edit.id) == digest_of(edit)]
    now = stored_annotations(connection, (edit.annotation for edit in again))
    return {edit.id: Accepted(edit=edit.id, annotation=now[edit.annotation]) for edit in again}


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


def _check_caps(project: Project, edits: Sequence[Derived]) -> list[Cap | FairyringError | None]:
    """The cap of each edit as it can be stored, or why it cannot; None where the edit has none."""
    photos: dict[int, AnyRow] = {}
    checked: list[Cap | FairyringError | None] = []
    for derived in edits:
        try:
            checked.append(_check(project, derived, photos))
        except FairyringError as error:
            checked.append(error)
    return checked


def _check(project: Project, derived: Derived, photos: dict[int, AnyRow]) -> Cap | None:
    edit = derived.edit
    if derived.unfit:
        raise StoreError(derived.unfit)
    if edit.cap is None or derived.checked is not None:
        return derived.checked
    if edit.image not in photos:
        with project.read() as connection:
            photos[edit.image] = require_image(connection, edit.image)
    photo = photos[edit.image]
    return check_cap(edit.cap, width=photo.width, height=photo.height)


def _commit_all(
    connection: Connection,
    edits: Sequence[Derived],
    checked: Sequence[Cap | FairyringError | None],
    *,
    user: str,
) -> list[Outcome]:
    ledger = open_ledger(connection, [derived.edit for derived in edits], user=user)
    outcomes = [
        _commit_one(connection, ledger, derived, cap, user=user)
        for derived, cap in zip(edits, checked, strict=True)
    ]
    entered = ledger.write(connection)
    recount(connection, (image for image, _ in entered))
    for (image, number), takes_back in entered.items():
        follow_edits(connection, image, number, takes_back=takes_back, user=user)
    return outcomes


def _commit_one(
    connection: Connection,
    ledger: Ledger,
    derived: Derived,
    checked: Cap | FairyringError | None,
    *,
    user: str,
) -> Outcome:
    edit = derived.edit
    try:
        check_name(edit.id, "number of an edit")
        check_name(edit.annotation, "number of an annotation")
        check_change_set(edit)
        digest, current = digest_of(edit), ledger.annotations.get(edit.annotation)
        if _was_sent_before(ledger, edit, digest):
            assert current is not None, "the journal names annotations that exist"
            return Accepted(edit=edit.id, annotation=current)
        if current is not None and current.image != edit.image:
            raise StoreError("This annotation belongs to another image.")
        if current is None and edit.base != 0:
            raise StoreError("There is no such annotation; reload the image.")
        if current is not None and not _is_made_on(edit, current):
            return Conflict(edit=edit.id, theirs=current, user=ledger.last_editor(connection, current.uid))
        if (other := _taken_up_by(ledger, edit, current)) is not None:
            return Conflict(edit=edit.id, theirs=other, user=ledger.last_editor(connection, other.uid))
        cap = _fitting(connection, ledger, edit, checked)
    except FairyringError as error:
        return Refused(edit=edit.id, reason=str(error))
    annotation = ledger.record(edit, cap, derived.fit, digest=digest, user=user)
    return Accepted(edit=edit.id, annotation=annotation)


def _was_sent_before(ledger: Ledger, edit: Edit, digest: str) -> bool:
    known = ledger.digests.get(edit.id)
    if known is not None and known != digest:
        raise StoreError("Another edit has this number; reload the page.")
    return known is not None


def _is_made_on(edit: Edit, current: Annotation) -> bool:
    """Whether an edit was made on the annotation as it is now; only who saw a deletion can undo it."""
    return edit.base == current.revision and not (current.deleted and edit.cap is None)


def _taken_up_by(ledger: Ledger, edit: Edit, current: Annotation | None) -> Annotation | None:
    """The annotation that somebody else made of the prediction which this edit takes up."""
    if edit.cap is None or edit.cap.prediction is None:
        return None
    has_it = current is not None and not current.deleted and current.cap.prediction == edit.cap.prediction
    return None if has_it else ledger.holder_of(edit.cap.prediction, besides=edit.annotation)


def _fitting(
    connection: Connection, ledger: Ledger, edit: Edit, checked: Cap | FairyringError | None
) -> Cap | None:
    """The checked cap, once it is known to fit what else the project holds."""
    if edit.image not in ledger.images:
        require_image(connection, edit.image)
    if edit.cap is None:
        if edit.base == 0:
            raise StoreError("An annotation that was never made cannot be deleted.")
        return None
    # May be used before anybody has made it; other categories come from imports.
    if edit.cap.category == DEFAULT_CATEGORY:
        ensure_category(connection, DEFAULT_CATEGORY, categories=ledger.categories)
    if edit.cap.category not in ledger.categories:
        raise StoreError(f"The project has no category “{edit.cap.category}”.")
    if edit.cap.prediction is not None and (edit.cap.prediction, edit.image) not in ledger.predictions:
        raise StoreError("The prediction this cap started from does not belong to this image.")
    if isinstance(checked, FairyringError):
        raise checked
    return checked
