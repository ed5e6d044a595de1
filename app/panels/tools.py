"""The toolbar: what the editor can do, with the keys that do it, and the image's own buttons."""

from __future__ import annotations

from fairyring.app.live.session import Session
from fairyring.app.panels.buttons import labelled_button, tool_button, worded_button
from fairyring.app.panels.markup import Markup, element

TOOLS = ("select", "point", "polygon", "circle", "rim_points", "rim", "split", "arcs", "pan")
STATUSES = ("to_do", "annotated", "approved")
COMMANDS = ("undo", "redo", "tighten", "check", "accept_all", "done", "help")


def build(session: Session) -> None:
    """Builds the toolbar."""
    session.client.gui.add_html(toolbar().html)


def toolbar() -> Markup:
    """The toolbar: tools above, then commands, then what can be said of the image."""
    return element(
        "div",
        element("div", *map(tool_button, TOOLS), class_="fr-tools", role="toolbar", aria_label="Tools"),
        element("div", *map(labelled_button, COMMANDS), class_="fr-commands"),
        element(
            "div", *map(worded_button, STATUSES), class_="fr-statuses", role="group", aria_label="Status"
        ),
        class_="fr-toolbar",
    )
