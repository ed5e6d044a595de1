"""Tells every tab what people say of images now."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import StatusChanged
from fairyring.storage.records import Image


def announce_statuses(workspace: Workspace, images: Iterable[Image], *, user: str) -> None:
    """Tells every tab that shows one of these images its status, and has every list follow."""
    changed = [tell_status(tab, image, user=user) for image in images for tab in workspace.tabs]
    if any(changed):
        workspace.follow("status", "images", "history", "desk")


def tell_status(tab: Session, image: Image, *, user: str) -> bool:
    """Tells a tab that shows this image its status, where that is news; whether it was."""
    if tab.caps is None or not tab.shows(image.id):
        return False
    before = tab.caps.image
    tab.caps = replace(tab.caps, image=image)
    if before.status == image.status:
        return False
    tab.send(StatusChanged(image=image.id, status=image.status, user=user))
    return True
