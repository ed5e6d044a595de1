"""The toolbar: what the editor can do, with the keys that do it, and the image's own buttons."""

from __future__ import annotations

from fairyring.app.live.opening import set_status
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import person_did
from fairyring.app.panels.icons import icon
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import STATUS_OF_WORD

TOOLS = (
    ("select", "Select", "V"),
    ("polygon", "Outline", "W"),
    ("circle", "Circle", "C"),
    ("pan", "Pan", "G"),
)
COMMANDS = (
    ("undo", "Undo", "Ctrl+Z"),
    ("redo", "Redo", "Ctrl+Shift+Z"),
    ("fit", "Fit the photo", "F"),
    ("accept_all", "Accept all open predictions", "Shift+A"),
    ("done", "Annotated, and on to the next", "Ctrl+Enter"),
    ("help", "All keys", "?"),
)


def build(workspace: Workspace, session: Session) -> None:
    """The toolbar, and the buttons for the status of the image."""
    gui = session.client.gui
    gui.add_html(toolbar().html)
    status = gui.add_button_group("Set status", tuple(word.capitalize() for word in STATUS_OF_WORD))

    async def press() -> None:
        if session.image is not None:
            await set_status(workspace, session, session.image.id, STATUS_OF_WORD[status.value.lower()])

    status.on_click(person_did(session, press))


def toolbar() -> Markup:
    """Buttons that the editor listens to: tools above, commands below."""
    return element(
        "div",
        element(
            "div", *(_tool(*tool) for tool in TOOLS), class_="fr-tools", role="toolbar", aria_label="Tools"
        ),
        element("div", *(_command(*command) for command in COMMANDS), class_="fr-commands"),
        class_="fr-toolbar",
    )


def _tool(name: str, label: str, key: str) -> Markup:
    return element(
        "button",
        icon(name),
        element("span", label, element("kbd", key)),
        type="button",
        title=f"{label} ({key})",
        data_fairyring_tool=name,
    )


def _command(name: str, label: str, key: str) -> Markup:
    return element(
        "button",
        icon(name),
        type="button",
        title=f"{label} ({key})",
        aria_label=label,
        data_fairyring_command=name,
    )
