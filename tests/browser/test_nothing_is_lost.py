"""Power cuts, broken connections, closed tabs, two people at one cap."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.kept import kept_cap, live_caps

BACK = "window.fairyring.state.connection === 'online'"


def draw_circle(tab: Tab, at: tuple[float, float], radius: float) -> None:
    count = len(tab.state("shapes"))
    tab.press("Escape", "c")
    tab.drag(at, (at[0] + radius, at[1]))
    tab.wait_for(f"window.fairyring.state.shapes.length === {count + 1}")


def reconnect(tab: Tab) -> None:
    # viser's client tries again only while its tab has the focus.
    tab.page.bring_to_front()
    tab.wait_for(BACK)


def test_acknowledged_edits_survive_a_power_cut(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    for place in range(5):
        draw_circle(tab, (40.0 + 60 * place, 30.0), 12.0 + place)
        tab.saved()
    server.kill()
    assert len(live_caps(project)) == 5
    server.start()
    again = open_tab(server)
    assert sorted(shape["cap"]["mark"]["r"] for shape in again.state("shapes")) == pytest.approx(
        [12, 13, 14, 15, 16], abs=1.0
    )


def test_an_edit_made_offline_is_saved_after_reconnect(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    server.kill()
    tab.wait_for("window.fairyring.state.connection !== 'online'")
    draw_circle(tab, (40.0, 30.0), 14.0)
    assert tab.state("waiting") > 0
    assert live_caps(project) == []
    tab.page.get_by_text("Offline").first.wait_for()
    server.start()
    reconnect(tab)
    tab.saved()
    assert len(live_caps(project)) == 1
    assert len(tab.state("shapes")) == 1


def test_an_edit_made_offline_survives_the_tab(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    server.kill()
    tab.wait_for("window.fairyring.state.connection !== 'online'")
    draw_circle(tab, (40.0, 30.0), 14.0)
    context = tab.page.context
    tab.page.close()
    server.start()
    second = Tab(context.new_page())
    second.enter(server.url, name="Ada")
    second.wait_for("window.fairyring.state.shapes.length === 1")
    second.saved()
    assert len(live_caps(project)) == 1


def test_a_browser_that_is_closed_at_once_after_an_edit_loses_nothing(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    draw_circle(tab, (40.0, 30.0), 14.0)
    context = tab.page.context
    tab.page.close()
    second = Tab(context.new_page())
    second.enter(server.url, name="Ada")
    second.wait_for("window.fairyring.state.shapes.length === 1")
    second.saved()
    assert len(live_caps(project)) == 1


def test_what_one_person_draws_appears_at_the_others(server: Server, open_tab: Callable[..., Tab]) -> None:
    ada, ben = open_tab(server, name="Ada"), open_tab(server, name="Ben")
    ben.page.bring_to_front()
    draw_circle(ada, (40.0, 30.0), 14.0)
    ada.saved()
    ben.wait_for("window.fairyring.state.shapes.length === 1")


def test_tabs_on_different_images_do_not_mix(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    ada, ben = open_tab(server, name="Ada"), open_tab(server, name="Ben")
    ben.press("n")
    ben.wait_for(f"window.fairyring.state.image.id !== {ada.state('image')['id']}")
    draw_circle(ada, (40.0, 30.0), 14.0)
    draw_circle(ben, (90.0, 40.0), 17.0)
    ada.saved()
    ben.saved()
    [of_ada], [of_ben] = ada.state("shapes"), ben.state("shapes")
    for tab, shape, name in ((ada, of_ada, "Ada"), (ben, of_ben, "Ben")):
        kept = kept_cap(project, shape["uid"])
        assert kept is not None
        assert (kept["image"], kept["edited_by"]) == (tab.state("image")["id"], name)


def test_two_edits_of_one_cap_become_a_conflict_that_shows_both(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    ada, ben = open_tab(server, name="Ada"), open_tab(server, name="Ben")
    draw_circle(ada, (60.0, 60.0), 20.0)
    ada.saved()
    [shape] = ada.state("shapes")
    ben.wait_for("window.fairyring.state.shapes.length === 1")

    server.kill()
    for tab, key in ((ada, "ArrowRight"), (ben, "Shift+ArrowDown")):
        tab.wait_for(f"!({BACK})")
        tab.press("Escape", "v")
        tab.select((60.0, 60.0))
        tab.press(key)
    server.start()
    reconnect(ben)
    reconnect(ada)
    # Whose edit comes first is a matter of milliseconds; the other person is asked.
    first, second, name = (ben, ada, "Ada") if is_asked(ada, ben) else (ada, ben, "Ben")
    first.saved()
    theirs = kept_cap(project, shape["uid"])
    assert theirs is not None
    assert theirs["edited_by"] != name
    second.page.bring_to_front()
    second.page.get_by_role("button", name="Keep mine").click()
    second.saved()
    kept = kept_cap(project, shape["uid"])
    assert kept is not None
    assert kept["edited_by"] == name
    assert kept["revision"] == theirs["revision"] + 1
    right, down = (0.25, 0.0) if name == "Ada" else (0.0, 1.0)
    assert kept["mark"]["cx"] == pytest.approx(shape["cap"]["mark"]["cx"] + right)
    assert kept["mark"]["cy"] == pytest.approx(shape["cap"]["mark"]["cy"] + down)


def is_asked(tab: Tab, other: Tab) -> bool:
    """Waits until one of two tabs is asked which cap to keep; True if it is the first one."""
    for _ in range(300):
        for candidate in (tab, other):
            if candidate.page.get_by_role("button", name="Keep mine").count():
                return candidate is tab
        tab.page.wait_for_timeout(100)
    raise AssertionError("nobody was shown the conflict")
