"""The reviewer's desk: what can be said of the image on screen, by which keys, and what was said of it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from sqlalchemy import Connection

from fairyring.app.editor_commands import COMMANDS
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.verdicts import verdict_list
from fairyring.storage.records import GivenVerdict, Rules
from fairyring.storage.rules import rules_of, set_rules
from fairyring.storage.verdicts import verdicts_of

ON_CAPS = ("next_difference", "previous_difference", "take_models", "take_annotators", "comment")
ON_IMAGES = ("approve", "send_back", "reject", "next_image")
OF_THE_PICTURE = ("review", "blink", "magnify")


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the desk."""
    gui = session.client.gui
    gui.add_html(keys_on_screen().html)
    shown = gui.add_html("")
    own = gui.add_checkbox(
        "Approve own work", initial_value=False, hint="For everybody in this project: needs no second person"
    )

    async def allow() -> None:
        rules = Rules(approve_own=own.value)
        await workspace.write(partial(set_rules, rules=rules))
        workspace.refresh("desk")

    async def redraw() -> None:
        image_id = session.image.id if session.image else None
        rules, verdicts = await workspace.read(partial(_load, image_id=image_id))
        own.value = rules.approve_own
        shown.content = said_of_image(verdicts).html

    own.on_update(person_did(session, allow))
    return redraw


def _load(connection: Connection, *, image_id: int | None) -> tuple[Rules, list[GivenVerdict]]:
    return rules_of(connection), [] if image_id is None else verdicts_of(connection, image_id)


def said_of_image(verdicts: Sequence[GivenVerdict]) -> Markup:
    """What reviewers said of the image on screen."""
    listed = verdict_list(verdicts) or element("div", "Nobody has said anything of this image yet.")
    return element(
        "section",
        element("h3", "Said of this image", class_="fr-heading"),
        listed,
        class_="fr-review fr-verdicts",
        aria_label="Said of this image",
    )


def keys_on_screen() -> Markup:
    """A button for everything a reviewer does, with its key."""
    return element(
        "div",
        *(
            element("div", *map(_button, names), class_="fr-desk-row")
            for names in (ON_CAPS, ON_IMAGES, OF_THE_PICTURE)
        ),
        class_="fr-review fr-desk",
        role="group",
        aria_label="Review",
    )


def _button(name: str) -> Markup:
    command = COMMANDS[name]
    return element(
        "button",
        element("kbd", command.keys[0]),
        element("span", command.label or command.words),
        type="button",
        title=command.title,
        data_fairyring_command=name,
    )
