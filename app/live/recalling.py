"""Answers from the journal what it takes to take back what was done before this page was loaded."""

from __future__ import annotations

from sqlalchemy import Connection

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Recall, Recalled
from fairyring.storage.reversals import Reversal, next_reversal, reversal_of


async def recall(workspace: Workspace, session: Session, request: Recall) -> None:
    """Looks up a change set of an image; the editor takes it back as it does its own, by edits."""

    def look_up(connection: Connection) -> Reversal | None:
        if request.change_set is not None:
            return reversal_of(connection, request.image, request.change_set)
        return next_reversal(connection, request.image, user=session.user, way=request.way)

    found = await workspace.read(look_up)
    session.send(
        Recalled(image=request.image, way=request.way, change_set=request.change_set, reversal=found)
    )
