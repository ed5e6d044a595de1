"""What the page says to the person before it."""

from fairyring.app.bench.browser.tab import Tab


def said(tab: Tab, text: str) -> None:
    """Waits until a notice holds this text."""
    tab.page.locator(".fairyring-notice").filter(has_text=text).first.wait_for()
