"""Changes that another process makes to the project: an import, a prediction, a script. Open tabs follow."""

from __future__ import annotations

import asyncio
import logging

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.live.missing_outlines import find_other_outlines, find_outlines_of
from fairyring.app.live.opening import CHANGES_IMAGE, reopen
from fairyring.app.live.reviewing import follow_run_on_photo
from fairyring.app.live.session import Session
from fairyring.app.live.statuses import tell_status
from fairyring.app.live.taking_out import leave_missing
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Changed, Predicted
from fairyring.model.errors import FairyringError
from fairyring.storage.contents import load_annotation
from fairyring.storage.records import Annotation, ImageContents

log = logging.getLogger(__name__)

EVERY_S = 1.0
SOMEBODY = "another program"
"""Who made a change that came in from outside, to those who see it."""


async def watch(workspace: Workspace) -> None:
    """Looks once a second, until it is cancelled, whether others have written, and shows what they wrote."""
    seen = await _written_by_others(workspace)
    while seen is not None:
        await asyncio.sleep(EVERY_S)
        try:
            now = await _written_by_others(workspace)
            if now != seen:
                await catch_up(workspace)
                seen = now
        except FairyringError as error:
            log.warning("What others wrote cannot be read now: %s", error)


async def _written_by_others(workspace: Workspace) -> int | None:
    return await anyio.to_thread.run_sync(workspace.project.written_by_others)


async def catch_up(workspace: Workspace) -> None:
    """Brings every tab up to what the store holds now."""
    await leave_missing(workspace)
    for image_id in {tab.image.id for tab in workspace.tabs if tab.image is not None}:
        await find_outlines_of(workspace, image_id)
        _, contents = await workspace.read(lambda c, i=image_id: workspace.recent.load(c, i))
        for tab in workspace.tabs.others_on(image_id):
            gone = await workspace.read(lambda c, t=tab, now=contents: _deleted(c, t, now))
            _bring_up_to(tab, contents, gone)
    for tab in workspace.tabs:
        if tab.image is None and tab.outbox is not None:
            await reopen(workspace, tab, None)
        await follow_run_on_photo(workspace, tab)
    workspace.refresh(*CHANGES_IMAGE, "gallery", "beside", "plots", "predict", "runs")
    await find_other_outlines(workspace)


def _deleted(connection: Connection, tab: Session, contents: ImageContents) -> list[Annotation]:
    """What the tab shows and the store has no longer, as it was deleted."""
    live = {annotation.uid for annotation in contents.annotations}
    known = tab.caps.annotations.values() if tab.caps else ()
    missing = [each.uid for each in known if not each.deleted and each.uid not in live]
    found = [load_annotation(connection, uid) for uid in missing]
    return [annotation for annotation in found if annotation is not None and annotation.deleted]


def _bring_up_to(tab: Session, contents: ImageContents, gone: list[Annotation]) -> None:
    """Tells one tab what is new to it; on caps it is storing an edit of, the journal's answer tells it."""
    if tab.caps is None or not tab.shows(contents.image.id):
        return
    known = tab.caps.annotations
    changed = [
        annotation
        for annotation in [*contents.annotations, *gone]
        if annotation.uid not in tab.storing and _is_news(annotation, known.get(annotation.uid))
    ]
    if changed:
        tab.take_in(changed)
        tab.send(Changed(image=contents.image.id, annotations=changed, user=SOMEBODY))
    if contents.predictions != tab.caps.predictions or contents.run != tab.run:
        tab.take_predictions(contents)
        tab.send(Predicted(image=contents.image.id, predictions=contents.predictions))
    tell_status(tab, contents.image, user=SOMEBODY)


def _is_news(annotation: Annotation, known: Annotation | None) -> bool:
    return known is None or known.revision < annotation.revision
