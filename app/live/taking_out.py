"""Takes the image of a tab out of the project, puts images back, and leads tabs away from what is gone."""

from __future__ import annotations

from functools import partial

import anyio.to_thread

from fairyring.app.live.opening import CHANGES_IMAGE, open_image, reopen
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ImageFilter, list_ids, position_in_list
from fairyring.storage.taken_out import put_back, take_out, taken_out


async def take_out_shown(workspace: Workspace, session: Session) -> None:
    """Takes out the image on a tab's screen; tabs that show it go on to the next of their list.

    Raises StoreError where edits of it are not stored yet, or the disk cannot be written to.
    """
    if session.image is None:
        return
    if session.waiting:
        raise StoreError("Edits of this image are not stored yet; take it out once it says Saved.")
    image = session.image
    next_of = {tab.client.client_id: await _next_of(workspace, tab, image.id) for tab in workspace.tabs}
    await anyio.to_thread.run_sync(partial(take_out, workspace.project, [image.id], user=session.user))
    session.notify(f"{image.file_name} was taken out. Put back undoes it, until the project is closed.")
    for tab in workspace.tabs:
        tab.queue = tuple(number for number in tab.queue if number != image.id)
    for tab in workspace.tabs.others_on(image.id):
        tab.caps = None
        await reopen(workspace, tab, next_of[tab.client.client_id])
    workspace.refresh(*CHANGES_IMAGE, "gallery", "plots")


async def put_back_last(workspace: Workspace, session: Session) -> None:
    """Puts back the image that was taken out last, and shows it. Raises StoreError if its name is taken."""
    kept = await anyio.to_thread.run_sync(taken_out, workspace.project)
    if not kept:
        return
    await anyio.to_thread.run_sync(put_back, workspace.project, kept[:1])
    await open_image(workspace, session, kept[0].number)
    workspace.refresh(*CHANGES_IMAGE, "gallery", "plots")


async def leave_missing(workspace: Workspace) -> None:
    """Leads tabs away from images that somebody has taken out by a command."""
    shown = {tab.image.id for tab in workspace.tabs if tab.image is not None}
    there = set(await workspace.read(lambda connection: list_ids(connection, ImageFilter())))
    gone = shown - there
    for tab in workspace.tabs:
        tab.queue = tuple(number for number in tab.queue if number in there)
        if tab.image is not None and tab.image.id in gone:
            tab.notify(f"{tab.image.file_name} was taken out of the project.", "warning")
            tab.caps = None
            await reopen(workspace, tab, None)


async def _next_of(workspace: Workspace, tab: Session, image_id: int) -> int | None:
    """What a tab that shows this image shows after it."""
    if not tab.shows(image_id):
        return None
    found = await workspace.read(lambda connection: position_in_list(connection, tab.filter, image_id))
    return found.previous if found.next is None else found.next
