"""Takes over what files say of caps that the project has: as edits in the journal, like any other."""

from __future__ import annotations

from collections.abc import Sequence
from uuid import uuid4

from sqlalchemy import Connection

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.choices import KnownCaps
from fairyring.storage.db.counters import recount
from fairyring.storage.importing.comparing import Compared
from fairyring.storage.journal import digest_of
from fairyring.storage.ledger import open_ledger
from fairyring.storage.records import Annotation, Cap, Edit
from fairyring.storage.statuses import follow_edits


def edits_of(compared: Compared, known_caps: KnownCaps) -> list[Edit]:
    """The edits that bring the caps of a photo to what files say of them."""
    if known_caps not in (KnownCaps.update, KnownCaps.replace):
        return []
    edits = [_edit(change.annotation, change.cap) for change in compared.changed]
    if known_caps is KnownCaps.replace:
        edits += [_edit(change.annotation, change.cap) for change in compared.deleted]
        edits += [_edit(annotation, None) for annotation in compared.gone]
    return edits


def record(connection: Connection, edits: Sequence[Edit], *, user: str) -> None:
    """Stores edits that were made on the annotations as they are; what follows from them is lacking then."""
    if not edits:
        return
    ledger = open_ledger(connection, edits, user=user)
    for edit in edits:
        ledger.record(edit, edit.cap, Fit(), digest=digest_of(edit), user=user)
    entered = ledger.write(connection)
    recount(connection, {image for image, _ in entered})
    for image, number in entered:
        follow_edits(connection, image, number, takes_back=False, user=user)


def _edit(annotation: Annotation, cap: Cap | None) -> Edit:
    return Edit(
        id=f"import-{uuid4().hex}",
        annotation=annotation.uid,
        image=annotation.image,
        base=annotation.revision,
        cap=cap,
    )
