"""The toolbar: what the editor can do, with the keys that do it, and the image's own buttons."""

from __future__ import annotations

from typing import Literal

from app.opening import set_status, step
from app.panels.callbacks import person_did
from app.panels.icons import icon
from app.panels.markup import Markup, element
from app.session import Session
from app.workspace import Workspace
from storage.records import Status

TOOLS = (
    ("select", "Select", "V"),
    ("polygon", "Outline", "P"),
    ("circle", "Circle", "C"),
    ("pan", "Pan", "Space"),
)
COMMANDS = (
    ("undo", "Undo", "Ctrl+Z"),
    ("redo", "Redo", "Ctrl+Shift+Z"),
    ("fit", "Whole image", "F"),
    ("accept_all", "Accept all predictions", "Shift+A"),
    ("help", "Keys", "?"),
)


def build(workspace: Workspace, session: Session) -> None:
    """The toolbar, and the buttons that go from image to image."""
    gui = session.client.gui
    gui.add_html(toolbar().html)
    buttons = gui.add_button_group("Image", ("‹ Back", "Next ›", "Done", "Approve"))

    async def press() -> None:
        match buttons.value:
            case "‹ Back":
                await _go(-1)
            case "Next ›":
                await _go(1)
            case "Done":
                await _finish("annotated")
            case "Approve":
                await _finish("approved")

    async def _go(by: Literal[-1, 1]) -> None:
        await step(workspace, session, by)

    async def _finish(status: Status) -> None:
        if session.image is not None:
            await set_status(workspace, session, session.image.id, status)

    buttons.on_click(person_did(session, press))


def toolbar() -> Markup:
    """Buttons that the editor listens to: tools above, commands below."""
    return element(
        "div",
        element("div", *(_tool(*tool) for tool in TOOLS), class_="fr-tools", role="toolbar", aria_label="Tools"),
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
