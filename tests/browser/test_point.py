"""A click takes the cap that the network sees under the pointer."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from shapely import Polygon

from fairyring.app.bench.browser.tab import Tab, centroid
from fairyring.app.bench.serving import Server, served
from tests.support.kept import kept_cap, live_caps

SAME_CAP = 0.5
"""IoU from which two outlines are of one cap: what a click finds need not be what a prediction drew."""


def likeness(a: list[float], b: list[float]) -> float:
    """IoU of two rings."""
    first, second = (Polygon([*zip(ring[::2], ring[1::2], strict=True)]).buffer(0) for ring in (a, b))
    return first.intersection(second).area / first.union(second).area


@pytest.fixture(autouse=True)
def look_ahead() -> None:
    """The network looks at photos before anybody points, as usual."""


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def test_a_missed_cap_is_taken_by_a_click_and_another_by_a_box(tab: Tab, project: Path) -> None:
    large = sorted(tab.state("predictions"), key=lambda p: -len(p["cap"]["visible"][0]))
    sure = [p["cap"]["visible"][0] for p in large if p["score"] > 0.9][:2]
    for ring in sure:
        tab.page.mouse.move(*tab.screen(centroid(ring)))
        tab.page.mouse.move(*tab.screen((centroid(ring)[0] + 2, centroid(ring)[1])))
        tab.press("Delete")
    tab.saved()
    assert live_caps(project) == []
    tab.press("e")
    tab.click(centroid(sure[0]))
    tab.page.wait_for_function("() => window.fairyring.state.shapes.length === 1", timeout=120_000)
    tab.saved()
    [uid] = live_caps(project)
    kept = kept_cap(project, uid)
    assert kept is not None
    assert (kept["prediction"], kept["centre_x"] is None) == (None, False)
    assert likeness(kept["visible"][0], sure[0]) > SAME_CAP
    xs, ys = sure[1][::2], sure[1][1::2]
    tab.drag((min(xs) - 1, min(ys) - 1), (max(xs) + 1, max(ys) + 1))
    tab.wait_for("window.fairyring.state.shapes.length === 2")
    tab.saved()
    [another] = set(live_caps(project)) - {uid}
    other = kept_cap(project, another)
    assert other is not None
    assert likeness(other["visible"][0], sure[1]) > SAME_CAP
    assert tab.state("tool") == "point"
    tab.press("Control+z", "Control+z")
    tab.saved()
    assert live_caps(project) == []


def test_the_network_looks_at_a_photo_on_which_somebody_stays_and_answers_at_once(tab: Tab) -> None:
    tab.wait_for("window.fairyring.state.asking")
    tab.page.wait_for_function("() => !window.fairyring.state.asking", timeout=120_000)
    ring = max(tab.state("predictions"), key=lambda p: p["score"])["cap"]["visible"][0]
    tab.page.mouse.move(*tab.screen(centroid(ring)))
    tab.page.mouse.move(*tab.screen((centroid(ring)[0] + 2, centroid(ring)[1])))
    tab.press("Delete", "e")
    tab.click(centroid(ring))
    tab.page.wait_for_function("() => window.fairyring.state.shapes.length === 1", timeout=5_000)
    assert likeness(tab.state("shapes")[0]["cap"]["visible"][0], ring) > SAME_CAP


def test_where_the_settings_want_it_so_the_network_looks_only_once_somebody_points(
    project: Path, open_tab: Callable[..., Tab]
) -> None:
    (project / "fairyring.toml").write_text("[serve]\nlook_ahead = false\n")
    with served(project) as server:
        tab = open_tab(server)
        tab.page.wait_for_timeout(2500)
        assert not tab.state("asking")
        tab.press("e")
        tab.click((3, 3))
        tab.wait_for("window.fairyring.state.asking")
