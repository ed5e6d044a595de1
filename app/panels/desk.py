"""The reviewer's desk: what can be said of the image on screen, by which keys, and what was said of it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from sqlalchemy import Connection

from fairyring.app.caps.repeated import repeated_marks
from fairyring.app.editor_commands import COMMANDS
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.verdicts import verdict_list
from fairyring.model.evaluate.repeated_marks import ENOUGH, RepeatedMark, floors_by_class
from fairyring.storage.records import GivenVerdict, Rules
from fairyring.storage.rules import rules_of, set_rules
from fairyring.storage.verdicts import verdicts_of

ON_CAPS = ("next_difference", "previous_difference", "take_models", "take_annotators", "comment")
ON_IMAGES = ("approve", "send_back", "reject", "next_image")
OF_THE_PICTURE = ("review", "blink", "magnify", "mark_again")


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the desk."""
    gui = session.client.gui
    keys = gui.add_html(keys_on_screen().html)
    shown = gui.add_html("")
    again = gui.add_html("")
    with gui.add_folder("Rules of this project", expand_by_default=False):
        own = gui.add_checkbox(
            "Approve own work",
            initial_value=False,
            hint="For everybody: needs no second person",
        )
        share = gui.add_number(
            "Mark again %",
            0.0,
            min=0.0,
            max=100.0,
            step=0.5,
            hint="Of the marked caps so many are asked for again, without their first mark",
        )
        seed = gui.add_number("Seed of these", 1, min=0, step=1, hint="Which caps they are follows from it")

    async def allow() -> None:
        rules = Rules(approve_own=own.value, repeat_share=share.value / 100, repeat_seed=int(seed.value))
        await workspace.write(partial(set_rules, rules=rules))
        workspace.refresh("desk")

    async def redraw() -> None:
        image_id = session.image.id if session.image else None
        keys.content = keys_on_screen(session.second_annotator).html
        rules, verdicts, repeats = await workspace.read(partial(_load, image_id=image_id))
        own.value = rules.approve_own
        share.value, seed.value = 100 * rules.repeat_share, rules.repeat_seed
        again.content = floors_found(repeats, rules).html
        shown.content = said_of_image(verdicts).html

    for rule in (own, share, seed):
        rule.on_update(person_did(session, allow))
    return redraw


def _load(
    connection: Connection, *, image_id: int | None
) -> tuple[Rules, list[GivenVerdict], list[RepeatedMark]]:
    said = [] if image_id is None else verdicts_of(connection, image_id)
    return rules_of(connection), said, repeated_marks(connection)


def floors_found(repeats: Sequence[RepeatedMark], rules: Rules) -> Markup:
    """How far off people's own marks are, as far as caps that were marked again tell."""
    if not repeats:
        told = "; ask for repeats in the rules below" if not rules.repeat_share else ""
        words = f"No cap was marked again yet, so floors are those of the marks' geometry{told}."
        return element("div", words, class_="fr-review fr-quiet")
    people = floors_by_class(repeats)["annotator"]
    rows = (
        element(
            "tr",
            element("td", name),
            element("td", f"{floor.mean:.3f} %", class_="fr-number"),
            element("td", f"{floor.low:.3f}–{floor.high:.3f}", class_="fr-number"),
            element("td", floor.count, class_="fr-number"),
        )
        for name, floor in people.items()
    )
    titles = ("Floor of", "CDR", "95 of 100", "Caps")
    head = element("tr", *(element("th", title, class_=_numeric(title)) for title in titles))
    return element(
        "section",
        element("table", element("thead", head), element("tbody", *rows), class_="fr-list"),
        element("div", f"Used from {ENOUGH} caps of a person on.", class_="fr-quiet"),
        class_="fr-review",
        aria_label="Marked again",
    )


def _numeric(title: str) -> str | None:
    return None if title == "Floor of" else "fr-number"


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


def keys_on_screen(second: str | None = None) -> Markup:
    """A button for everything a reviewer does, with its key; to a second annotator's version of this name."""
    return element(
        "div",
        *(
            element("div", *(_button(name, second) for name in names), class_="fr-desk-row")
            for names in (ON_CAPS, ON_IMAGES, OF_THE_PICTURE)
        ),
        class_="fr-review fr-desk",
        role="group",
        aria_label="Review",
    )


def _button(name: str, second: str | None) -> Markup:
    command = COMMANDS[name].beside(second)
    return element(
        "button",
        element("kbd", command.keys[0]),
        element("span", command.label or command.words),
        type="button",
        title=command.title,
        data_fairyring_command=name,
    )
