"""Commands, keys and layers are declared in one file, which the panel and the editor read."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.app.editor_commands import COMMANDS, LAYERS
from fairyring.app.panels.buttons import command_button, tool_button
from fairyring.app.panels.inspector import prediction_facts
from fairyring.app.panels.tools import toolbar
from fairyring.storage.records import Prediction

TOP = Path(__file__).parents[3]
DECLARATION = TOP / "static" / "editor" / "commands.js"


def test_a_button_says_what_it_does_and_by_which_key() -> None:
    assert (
        'title="Accept all open predictions from a score on (Shift+A)"' in command_button("accept_all").html
    )
    assert 'aria-label="Delete"' in command_button("delete").html
    assert 'title="Fit the photo (F)"' in command_button("fit").html
    assert "<span>Outline<kbd>W</kbd></span>" in tool_button("polygon").html


def test_a_button_for_something_that_is_not_declared_cannot_be_made() -> None:
    with pytest.raises(KeyError):
        command_button("explode")


def test_the_panel_offers_its_tools_and_commands_with_their_keys() -> None:
    prediction = Prediction(id=1, run=1, image=1, visible=[], score=0.5, category="mushroom")
    html = toolbar().html + prediction_facts(prediction, None).html
    for name in ("select", "polygon", "circle", "pan", "undo", "redo", "done", "help", "accept"):
        assert f'title="{COMMANDS[name].title}"' in html


def test_the_layers_are_named_once_with_keys_in_their_order() -> None:
    assert [layer.key for layer in LAYERS.values()] == [str(i) for i in range(1, len(LAYERS) + 1)]
    assert [name for name, layer in LAYERS.items() if not layer.shown] == ["label", "uncertainty"]


@pytest.mark.parametrize("folder", ["app", "static/editor"])
def test_the_words_of_commands_and_layers_stand_nowhere_else(folder: str) -> None:
    words = [text for command in COMMANDS.values() for text in (command.words, command.label)]
    words += [layer.words for layer in LAYERS.values()]
    phrases = {text for text in words if " " in text}
    assert len(phrases) > 20
    twice = [
        f"{file.relative_to(TOP)}: {phrase}"
        for file in sorted((TOP / folder).rglob("*.[jp][sy]"))
        if file != DECLARATION
        for phrase in phrases
        if f'"{phrase}"' in (source := file.read_text(encoding="utf-8")) or f'"{phrase} (' in source
    ]
    assert twice == []
