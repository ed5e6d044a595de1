"""Says the light, the form and the split of images, and tells every tab."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Tag
from fairyring.storage.images import get_image, set_light_and_form
from fairyring.storage.records import Image
from fairyring.storage.splits import set_splits


async def tag(workspace: Workspace, asked: Tag) -> None:
    """Stores what was said. Raises StoreError for an image that is gone, or no light, form or split."""
    _show(workspace, await workspace.write(partial(_store, asked)))


async def put_into_splits(workspace: Workspace, splits: Mapping[int, str | None]) -> dict[int, str | None]:
    """Puts images and copies of them into splits; returns what undoes it. Raises StoreError."""

    def store(connection: Connection) -> tuple[dict[int, str | None], list[Image]]:
        before = set_splits(connection, splits)
        return before, [get_image(connection, number) for number in before]

    before, images = await workspace.write(store)
    _show(workspace, images)
    return before


def _store(asked: Tag, connection: Connection) -> list[Image]:
    """Returns the image, and copies of it that are in another split now."""
    set_light_and_form(connection, asked.image, light=asked.light, form=asked.form)
    changed = set_splits(connection, {asked.image: asked.split})
    return [get_image(connection, number) for number in {asked.image, *changed}]


def _show(workspace: Workspace, images: Iterable[Image]) -> None:
    by_number = {image.id: image for image in images}
    for tab in workspace.tabs:
        if tab.caps is not None and tab.caps.image.id in by_number:
            tab.caps = replace(tab.caps, image=by_number[tab.caps.image.id])
            tab.refresh("cap")
    workspace.refresh("images")
