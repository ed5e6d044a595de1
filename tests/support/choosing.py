"""Choices from the lists of viser's panel."""

from __future__ import annotations

from playwright.sync_api import TimeoutError as TookTooLong

from fairyring.app.bench.browser.tab import Tab


def choose(tab: Tab, field: str, option: str) -> None:
    """Picks from a list of the panel; one that folds up because the panel is drawn anew is opened again."""
    listed = tab.page.get_by_role("option", name=option, exact=True).filter(visible=True)
    for _ in range(10):
        tab.page.get_by_role("combobox", name=field, exact=True).click()
        try:
            listed.click(timeout=3000)
        except TookTooLong:
            continue
        return
    raise AssertionError(f"The list {field} does not stay open long enough to choose {option}")
