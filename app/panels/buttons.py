"""Buttons that the editor listens to. Their words and keys are declared with its commands."""

from __future__ import annotations

from fairyring.app.editor_commands import COMMANDS
from fairyring.app.panels.icons import icon
from fairyring.app.panels.markup import Markup, element


def tool_button(name: str) -> Markup:
    """Takes up a tool; shows its name and key. Raises KeyError for a tool that is not declared."""
    tool = COMMANDS[name]
    return element(
        "button",
        icon(name),
        element("span", tool.label, element("kbd", tool.keys[0])),
        type="button",
        title=tool.title,
        data_fairyring_tool=name,
    )


def command_button(name: str, *, class_: str | None = None) -> Markup:
    """Runs a command; an icon that says the rest when pointed at. Raises KeyError for one not declared."""
    command = COMMANDS[name]
    return element(
        "button",
        icon(name),
        type="button",
        class_=class_,
        title=command.title,
        aria_label=command.label or command.words,
        data_fairyring_command=name,
    )


def labelled_button(name: str, second: str | None = None) -> Markup:
    """Runs a command; an icon and its name. Raises KeyError for one not declared.

    ``second``: the second annotator's version that photos are compared with, None for a model's.
    """
    command = COMMANDS[name].beside(second)
    return element(
        "button",
        icon(name),
        element("span", command.label or command.words),
        type="button",
        title=command.title,
        data_fairyring_command=name,
    )


def worded_button(name: str, *, class_: str | None = None) -> Markup:
    """Runs a command; shows its name. Raises KeyError for one not declared."""
    command = COMMANDS[name]
    return element(
        "button",
        command.label,
        type="button",
        class_=class_,
        title=command.title,
        data_fairyring_command=name,
    )
