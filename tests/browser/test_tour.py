"""The tour: each step goes on when it is done."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(200, 200, 60)], []], said=True)


def test_the_tour_goes_on_by_doing(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.page.get_by_role("button", name="Take the tour").click()
    tour = tab.page.get_by_role("region", name="Tour")
    tour.get_by_text("1 of 4").wait_for()
    tab.select((200, 200))
    tab.press("a")
    tour.get_by_text("2 of 4").wait_for()
    tab.press("r")
    tab.drag((260, 180), (275, 200), (260, 220))
    tour.get_by_text("3 of 4").wait_for()
    tab.press("c")
    tab.drag((200, 200), (250, 200))
    tour.get_by_text("4 of 4").wait_for()
    tab.press("Control+Enter")
    tour.get_by_text("That is all").wait_for()
    tour.get_by_role("button", name="Close").click()
    tour.wait_for(state="hidden")
