"""Says the light and the form of an image, and tells every tab."""

from __future__ import annotations

from dataclasses import replace

from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Tag
from fairyring.storage.images import set_light_and_form


async def tag(workspace: Workspace, asked: Tag) -> None:
    """Stores what was said. Raises StoreError for an image that is gone, or no light or form."""
    image = await workspace.write(
        lambda connection: set_light_and_form(connection, asked.image, light=asked.light, form=asked.form)
    )
    for tab in workspace.tabs:
        if tab.caps is not None and tab.shows(image.id):
            tab.caps = replace(tab.caps, image=image)
            tab.refresh("cap")
    workspace.refresh("images")
