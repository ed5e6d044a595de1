"""The tags of an image, which the filters of the list know: light, form of its caps, split."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.panels.markup import Markup, element
from fairyring.model.light_and_form import FORMS, LIGHTS
from fairyring.model.splits import Split
from fairyring.storage.records import Image


def tags_of(image: Image) -> Markup:
    """A choice for each tag; the editor says what was chosen."""
    return element(
        "div",
        _choice("Light", "light", LIGHTS, image.light),
        _choice("Form", "form", FORMS, image.form),
        _choice("Split", "split", tuple(Split), image.split, unsaid="none"),
        class_="fr-tags",
        data_fairyring_tags=image.id,
    )


def _choice(
    label: str, name: str, words: Sequence[str], chosen: str | None, *, unsaid: str = "not known"
) -> Markup:
    options = [element("option", unsaid, value="", selected=chosen is None)]
    options += [element("option", word, value=word, selected=word == chosen) for word in words]
    if chosen is not None and chosen not in words:
        options.append(element("option", chosen, value=chosen, selected=True))
    return element("label", element("span", label), element("select", *options, name=name))
