"""What lies over the photo leaves room for the rest of it in a narrow window."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(350, 200, 60, cut=330), ring(120, 120, 40)]], said=True)


def test_what_is_said_of_a_cap_does_not_lie_on_the_zoom_buttons_nor_a_question_on_the_panel(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    tab.page.set_viewport_size({"width": 1024, "height": 768})
    tab.ready()
    tab.select((315, 200))
    caption, buttons = (tab.page.locator(f".fairyring-{name}") for name in ("caption", "zoom"))
    caption.wait_for()
    # As long as what is said of an irregular cap with several arcs.
    caption.locator("*").first.evaluate("line => (line.textContent = 'behind a neighbour '.repeat(12))")
    left, right = caption.bounding_box(), buttons.bounding_box()
    assert left is not None
    assert right is not None
    assert left["x"] + left["width"] <= right["x"]
    tab.press("Shift+A")
    slider = tab.page.get_by_role("dialog").bounding_box()
    panel = tab.page.locator(".fr-toolbar").bounding_box()
    assert slider is not None
    assert panel is not None
    assert slider["x"] + slider["width"] <= panel["x"]
