"""Tables and numbers of a report."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.panels.markup import Content, Markup, element


def table(head: Sequence[str], rows: Sequence[Sequence[Content]]) -> Markup:
    """A table with a line of titles."""
    return element(
        "table",
        element("thead", element("tr", *(element("th", title) for title in head))),
        element("tbody", *(element("tr", *(element("td", value) for value in row)) for row in rows)),
    )


def number(value: float | None, decimals: int = 3) -> str:
    """A number, or a dash for what is not known."""
    return "–" if value is None else f"{value:.{decimals}f}"


def percent(share: float | None) -> str:
    """A share of 1 in percent."""
    return "–" if share is None else f"{100 * share:.2f}"
