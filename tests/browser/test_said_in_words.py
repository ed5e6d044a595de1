"""What a reviewer is asked when an image is sent back: in plain words, and nothing twice."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator, expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.project import open_project
from fairyring.storage.verdicts import verdicts_of
from tests.support.annotated_beds import make_annotated_beds, uid_of


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=2)


def lines_of(dialog: Locator) -> list[str]:
    """What stands in it, line by line."""
    return [line.strip() for line in dialog.inner_text().splitlines() if line.strip()]


def test_the_question_about_an_image_says_everything_once(
    project: Path, server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    tab.press("Shift+R")
    asked = tab.page.get_by_role("dialog", name="Send bed_1.png back: what is to be done?")
    asked.wait_for()
    assert lines_of(asked) == [
        "Send bed_1.png back: what is to be done?",
        *("1", "Caps are missing"),
        *("2", "Caps that are none"),
        *("3", "Outlines are off"),
        *("4", "Marks are off"),
        *("Cancel", "Esc"),
        *("Send back the image", "Enter"),
    ]
    field = asked.get_by_role("textbox")
    expect(field).to_be_focused()
    expect(field).to_have_attribute("placeholder", "Or in your own words")
    tab.press("Enter")
    asked.get_by_text("Say why first: press 1 to 4, or write it.").wait_for()
    tab.press("3", "Enter", "Enter")
    asked.wait_for(state="detached")
    tab.wait_for("window.fairyring.state.image.id === 2")
    tab.saved()
    with open_project(project) as opened, opened.read() as connection:
        assert [(v.says, v.words) for v in verdicts_of(connection, 1)] == [("sent_back", "Outlines are off")]
    notices = tab.page.locator(".fairyring-notice", has_text="Sent bed_1.png back: “Outlines are off”.")
    expect(notices).to_have_count(1)
    tab.press("p")
    tab.wait_for("window.fairyring.state.image.id === 1")
    card = tab.page.get_by_label("Selected cap")
    card.get_by_text("Rev sent back: Outlines are off").wait_for()
    assert card.get_by_text("Outlines are off").count() == 1


def test_with_a_cap_selected_it_asks_which_of_the_two_is_meant(
    project: Path, server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    tab.press(".")
    tab.wait_for(f"window.fairyring.state.selection[0] === {uid_of(1, 4)!r}")
    tab.press("Shift+R")
    asked = tab.page.get_by_role("dialog")
    asked.wait_for()
    buttons = [" ".join(each.inner_text().split()) for each in asked.get_by_role("button").all()]
    assert buttons[-3:] == ["Cancel Esc", "Send back this cap Ctrl+Enter", "Send back the image Enter"]
    tab.press("4", "Control+Enter")
    asked.wait_for(state="detached")
    tab.saved()
    assert tab.state("image")["id"] == 1
    with open_project(project) as opened, opened.read() as connection:
        said = [(v.says, v.words, v.annotation) for v in verdicts_of(connection, 1)]
    assert said == [("sent_back", "Marks are off", uid_of(1, 4))]
