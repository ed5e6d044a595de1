"""Opening images in a tab: one asked for, the next of the list, the last one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from msgspec.structs import replace
from sqlalchemy import Connection

from fairyring.app.addresses import photo_address
from fairyring.app.live.many_edits import get_ready
from fairyring.app.live.missing_outlines import find_outlines_of
from fairyring.app.live.session import Selection, Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Predicted, Show
from fairyring.storage import images
from fairyring.storage.contents import load_version
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ListPosition
from fairyring.storage.records import Image, ImageContents

CHANGES_IMAGE = ("status", "images", "cap", "history", "desk", "queue", "review", "cap_plot", "annotators")
"""The parts of the panel that depend on the image on screen."""


@dataclass(frozen=True)
class _Found:
    contents: ImageContents
    version: int
    position: ListPosition
    near: list[Image]


async def open_image(
    workspace: Workspace, session: Session, image_id: int, *, select: str | None = None
) -> None:
    """Shows an image in a tab. Raises StoreError where the project has no such image."""
    shown = None
    await find_outlines_of(workspace, image_id)
    # Until the tab shows the image it hears of no changes to it, so a look back follows.
    while shown is None or await workspace.read(lambda c: load_version(c, image_id)) != shown.version:
        shown = await workspace.read(lambda c: _find(workspace, c, image_id, session))
        _show(session, shown, select=select)
    session.refresh(*CHANGES_IMAGE)
    get_ready(workspace.crew, session)
    workspace.read_ahead([image.id for image in shown.near[:1]])


def position_of(connection: Connection, session: Session, image_id: int) -> ListPosition:
    """Where an image stands for a tab: in the queue of its person, else in the list as filtered.

    Raises StoreError where the project has no such image.
    """
    queue = session.queue
    if image_id not in queue:
        return images.position_in_list(connection, session.filter, image_id)
    at = queue.index(image_id)
    return ListPosition(
        position=at,
        count=len(queue),
        previous=queue[at - 1] if at else None,
        next=queue[at + 1] if at + 1 < len(queue) else None,
    )


def _find(workspace: Workspace, connection: Connection, image_id: int, session: Session) -> _Found:
    position = position_of(connection, session, image_id)
    near = [images.get_image(connection, i) for i in (position.next, position.previous) if i is not None]
    version, contents = workspace.recent.load(connection, image_id)
    return _Found(contents, version, position, near)


def _show(session: Session, found: _Found, *, select: str | None) -> None:
    session.show(found.contents)
    session.position, session.count = found.position.position, found.position.count
    session.selection = Selection(annotations=(select,) if select else ())
    session.send(
        Show(
            # What is held likely of whole outlines is for the server's fits, and as long as all outlines.
            contents=replace(found.contents, likely=[]),
            photo=photo_address(found.contents.image),
            select=select,
            position=session.position,
            count=session.count,
            ahead=[photo_address(image) for image in found.near],
        )
    )


async def reopen(workspace: Workspace, session: Session, image_id: int | None) -> None:
    """Shows the image a tab had on screen before its connection broke, else the first of the list."""
    if image_id is not None:
        try:
            await open_image(workspace, session, image_id)
            return
        except StoreError as gone:
            session.notify(str(gone), "warning")
    first = await workspace.read(
        lambda connection: images.list_images(connection, session.filter, limit=1).rows
    )
    if first:
        await open_image(workspace, session, first[0].image.id)
    else:
        session.notify("This project has no images yet: fairyring import takes them in.")
        session.refresh(*CHANGES_IMAGE)


async def step(workspace: Workspace, session: Session, by: Literal[-1, 1]) -> None:
    """Shows the next or the previous image of the list as filtered."""
    if session.image is None:
        await reopen(workspace, session, None)
        return
    here = session.image.id
    position = await workspace.read(lambda connection: position_of(connection, session, here))
    target = position.next if by == 1 else position.previous
    if target is None:
        session.notify(
            f"This is the {'last' if by == 1 else 'first'} image of the "
            f"{'queue' if here in session.queue else 'list'}."
        )
    else:
        await open_image(workspace, session, target)


async def show_predictions(workspace: Workspace, image_id: int) -> None:
    """Draws what a run has just said of an image in every tab that shows it or lists it."""
    _, contents = await workspace.read(lambda c: workspace.recent.load(c, image_id))
    for tab in workspace.tabs.others_on(image_id):
        tab.take_predictions(contents)
        tab.send(Predicted(image=image_id, predictions=contents.predictions))
        tab.refresh("status", "cap")
    workspace.refresh("images")
