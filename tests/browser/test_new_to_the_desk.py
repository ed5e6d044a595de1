"""Somebody who has never seen the desk decides with nothing but the keys that stand on the screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.images import get_image
from fairyring.storage.project import open_project
from fairyring.storage.verdicts import verdicts_of
from tests.support.annotated_beds import make_annotated_beds, uid_of
from tests.support.plain_bed import make_bed, ring


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=3)


def key_for(tab: Tab, words: str) -> str:
    """The key that stands before these words over the photo."""
    spans = tab.page.locator(".fairyring-review span:has(kbd)")
    spans.first.wait_for()
    said = {
        each.inner_text().partition(" ")[2].strip(): each.locator("kbd").inner_text() for each in spans.all()
    }
    return said[words]


def test_keys_over_the_photo_approve_reject_and_send_back(
    project: Path, server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_role("button", name="Both outlines").click()
    tab.press(key_for(tab, "Next"))
    tab.wait_for(f"window.fairyring.state.selection[0] === {uid_of(1, 4)!r}")
    tab.press(key_for(tab, "Annotator’s"))
    tab.wait_for("window.fairyring.state.selection[0]?.startsWith('prediction:')")
    tab.press(key_for(tab, "Model’s"))
    tab.saved()
    tab.press(key_for(tab, "Approve"))
    tab.wait_for("window.fairyring.state.image.id === 2")
    tab.press(key_for(tab, "Reject"), "1", "Enter")
    tab.wait_for("window.fairyring.state.image.id === 3")
    tab.press(key_for(tab, "Send back"), "2", "Enter")
    tab.saved()
    with open_project(project) as opened, opened.read() as connection:
        assert [get_image(connection, image).status for image in (1, 2, 3)] == ["approved", "new", "new"]
        said = [each for image in (2, 3) for each in verdicts_of(connection, image)]
    assert [(each.says, each.words) for each in said] == [
        ("rejected", "Out of focus"),
        ("sent_back", "Caps that are none"),
    ]


class TestWithoutAnyMark:
    @pytest.fixture
    def project(self, tmp_path: Path) -> Path:
        return make_bed(tmp_path, [[ring(80, 80, 40), ring(220, 90, 40)]], said=True)

    def test_the_desk_says_why_there_is_no_cdr(self, server: Server, open_tab: Callable[..., Tab]) -> None:
        tab = open_tab(server, name="Ada")
        tab.accept_all()
        tab.saved()
        tab.page.get_by_role("tab", name="Review").click()
        tab.page.get_by_text("No cap is marked, so there is no centre to measure from.").wait_for()
        totals = tab.page.locator(".fr-totals")
        assert totals.get_by_role("button").all_inner_texts() == ["0", "2", "0", "0"]
