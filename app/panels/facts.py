"""A card of facts in the panel, with buttons for what can be done. Its height is always the same, so that
nothing below it moves when something else is selected."""

from __future__ import annotations

from fairyring.app.panels.buttons import labelled_button
from fairyring.app.panels.markup import Content, Markup, element

Facts = list[tuple[str, Content]]


def definitions(facts: Facts, *, class_: str | None = None) -> Markup:
    """Terms with what is to be said of them."""
    rows = [part for term, fact in facts for part in (element("dt", term), element("dd", fact))]
    return element("dl", *rows, class_=class_)


def card(
    *title: Markup,
    facts: Facts,
    commands: tuple[str, ...] = (),
    second: str | None = None,
    below: Markup | None = None,
) -> Markup:
    """A title, terms with what is to be said of them, something ``below``, and buttons.

    ``second``: the second annotator's version that the commands are about, None for a model's.
    """
    buttons = [labelled_button(name, second) for name in commands]
    return element(
        "section",
        element("div", *title, class_="fr-line"),
        element("div", definitions(facts), below, class_="fr-facts", tabindex=0),
        element("div", *buttons, class_="fr-actions") if buttons else None,
        class_="fr-cap",
        aria_label="Selected cap",
    )
