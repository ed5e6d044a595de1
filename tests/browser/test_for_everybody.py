"""The page as axe-core sees it: contrast, names, roles; light and dark; less motion."""

from __future__ import annotations

from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring

WCAG = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(150, 150, 50), ring(350, 200, 60)], []], said=True)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nobody_is_kept_out(browser: Browser, server: Server, scheme: str) -> None:
    context = browser.new_context(
        viewport={"width": 1366, "height": 768}, color_scheme=scheme, reduced_motion="reduce"
    )
    page = context.new_page()
    page.goto(server.url)
    assert faults(page) == []
    tab = Tab(page)
    tab.enter(server.url, name="Ada")
    tab.wait_for(f"document.documentElement.dataset.mantineColorScheme === '{scheme}'")
    assert faults(page) == []
    tab.select((150, 150))
    page.locator(".fr-cap").get_by_text("Centre").wait_for()
    assert faults(page) == []
    for name in ("View", "History", "Review", "Jobs"):
        page.get_by_role("tab", name=name, exact=True).click()
        page.wait_for_timeout(500)
        assert faults(page) == [], name
    tab.press("F1")
    page.get_by_role("dialog", name="Keys").wait_for()
    assert faults(page) == []
    context.close()


def faults(page: object) -> list[str]:
    """What axe-core finds, each in a line."""
    found = Axe().run(page, options=WCAG).response["violations"]
    return [f"{each['id']}: {node['html'][:200]}" for each in found for node in each["nodes"]]


def test_the_search_field_has_a_name_and_the_focus_is_seen(browser: Browser, server: Server) -> None:
    tab = Tab(browser.new_context(viewport={"width": 1366, "height": 768}).new_page())
    tab.enter(server.url, name="Ada")
    tab.page.get_by_role("textbox", name="Search").wait_for()
    tab.click((600, 380))
    # Until then viser puts the header into the page anew, and what had the focus there is gone.
    tab.page.get_by_text("1 of 2", exact=True).wait_for()
    tab.page.wait_for_timeout(2000)
    tab.press("F6")
    assert tab.page.evaluate("document.activeElement.matches(':focus-visible')")
    assert tab.page.evaluate("getComputedStyle(document.activeElement).outlineStyle") != "none"
    assert not tab.page.evaluate("document.activeElement.closest('#fairyring-editor')")
    tab.press("F6")
    assert tab.page.evaluate("document.activeElement.id") == "fairyring-editor"
    tab.page.context.close()


def test_less_motion_is_less_motion(browser: Browser, server: Server) -> None:
    context = browser.new_context(viewport={"width": 1366, "height": 768}, reduced_motion="reduce")
    tab = Tab(context.new_page())
    tab.enter(server.url, name="Ada")
    moving = """() => [...document.querySelectorAll('*')].filter((e) => e.checkVisibility()
        && getComputedStyle(e).transitionDuration.split(', ').some((d) => parseFloat(d) > 0)).length"""
    assert tab.page.evaluate(moving) == 0
    context.close()
