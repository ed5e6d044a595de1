"""The view: which layers are drawn over the photo, by what caps are coloured, and how the photo looks.

All of it is the browser's business: the editor fills these controls in and follows them at once.
"""

from __future__ import annotations

from fairyring.app.editor_commands import LAYERS
from fairyring.app.live.session import Session
from fairyring.app.panels.buttons import worded_button
from fairyring.app.panels.markup import Markup, element

SLIDERS = {"brightness": "Brightness", "contrast": "Contrast", "gamma": "Gamma"}
CHANNELS = {"all": "all colours", "red": "red alone", "green": "green alone", "blue": "blue alone"}
COLOURINGS = {
    "none": "what they are",
    "score": "score",
    "quality": "how good the outline is likely to be",
    "sure": "how sure the centre is",
}


def build(session: Session) -> None:
    """Builds the view's page."""
    session.client.gui.add_html(view_page().html)


def view_page() -> Markup:
    """Check boxes for the layers, and controls of the photo."""
    layers = (
        element(
            "label",
            element("input", type="checkbox", data_fairyring_layer=layer.name),
            element("span", layer.words),
            element("kbd", layer.key),
        )
        for layer in LAYERS.values()
    )
    return element(
        "section",
        element("h3", "Shown"),
        element("div", *layers, class_="fr-layers"),
        _choice("Colour of caps", "colouring", COLOURINGS),
        element("h3", "Photo"),
        *(_slider(label, name) for name, label in SLIDERS.items()),
        _choice("Channel", "channel", CHANNELS),
        _box("Local contrast (CLAHE)", "local"),
        _box("Loupe at the pointer", "loupe"),
        worded_button("plain_photo"),
        class_="fr-view",
    )


def _slider(label: str, name: str) -> Markup:
    control = element("input", type="range", min=0.2, max=3, step=0.05, value=1, data_fairyring_look=name)
    return element("label", element("span", label), control, element("output", "1.00"), class_="fr-slider")


def _choice(label: str, name: str, words: dict[str, str]) -> Markup:
    options = (element("option", said, value=value) for value, said in words.items())
    return element(
        "label",
        element("span", label),
        element("select", *options, data_fairyring_look=name),
        class_="fr-choice",
    )


def _box(label: str, name: str) -> Markup:
    return element(
        "label",
        element("input", type="checkbox", data_fairyring_look=name),
        element("span", label),
        class_="fr-box",
    )
