"""What the page says to the person before it."""

from fairyring.app.bench.browser.tab import Tab

RECORDING = """
window.fairyringSaid = [];
new MutationObserver((changes) => {
  const added = changes.flatMap(({ addedNodes }) => [...addedNodes]);
  const notices = added.filter((node) => node instanceof Element && node.matches(".fairyring-notice"));
  window.fairyringSaid.push(...notices.map(({ textContent }) => textContent));
}).observe(document, { childList: true, subtree: true });
"""
"""For a new page: keeps what is said, as a notice may be gone again before a busy machine looks for it."""

HEARD = """(text) => {
  const place = window.fairyringSaid.findIndex((said) => said.includes(text));
  if (place >= 0) window.fairyringSaid.splice(0, place + 1);
  const shown = [...document.querySelectorAll(".fairyring-notice")];
  return place >= 0 || shown.some(({ textContent }) => textContent.includes(text));
}"""


def said(tab: Tab, text: str) -> None:
    """Waits until a notice holds this text, or takes one that came since the last that was waited for."""
    tab.page.wait_for_function(HEARD, arg=text, polling=50)
