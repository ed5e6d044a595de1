"""The toolbar: what the editor can do, with the keys that do it, and the image's own buttons."""

from __future__ import annotations

from fairyring.app.live.opening import set_status
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.buttons import command_button, tool_button
from fairyring.app.panels.callbacks import person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import STATUS_OF_WORD

TOOLS = ("select", "polygon", "circle", "pan")
COMMANDS = ("undo", "redo", "fit", "accept_all", "done", "help")


def build(workspace: Workspace, session: Session) -> None:
    """Builds the toolbar, and the buttons for the status of the image."""
    gui = session.client.gui
    gui.add_html(toolbar().html)
    status = gui.add_button_group("Set status", tuple(word.capitalize() for word in STATUS_OF_WORD))

    async def press() -> None:
        if session.image is not None:
            await set_status(workspace, session, session.image.id, STATUS_OF_WORD[status.value.lower()])

    status.on_click(person_did(session, press))


def toolbar() -> Markup:
    """The toolbar: tools above, commands below."""
    return element(
        "div",
        element("div", *map(tool_button, TOOLS), class_="fr-tools", role="toolbar", aria_label="Tools"),
        element("div", *map(command_button, COMMANDS), class_="fr-commands"),
        class_="fr-toolbar",
    )
