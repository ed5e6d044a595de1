"""HTML for viser's panel, which sets it as innerHTML: here every text and attribute is escaped."""

from __future__ import annotations

from html import escape

from msgspec import Struct


class Markup(Struct, frozen=True):
    """HTML that may go into a page as it is."""

    html: str

    def __str__(self) -> str:
        return self.html


Content = Markup | str | int | float | None

EMPTY = Markup("")


def element(tag: str, *children: Content, **attributes: str | float | bool | None) -> Markup:
    """One element. Children that are not Markup are text; None is left out.

    Attribute names lose a trailing underscore, and their other underscores become hyphens
    (``class_="row"``, ``data_fairyring_open=3``); None and False leave an attribute out.
    """
    written = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{escape(_value(value))}"'
        for name, value in attributes.items()
        if value is not None and value is not False
    )
    return Markup(f"<{tag}{written}>{join(children)}</{tag}>")


def join(parts: tuple[Content, ...] | list[Markup]) -> Markup:
    """Joins several pieces one after the other."""
    return Markup("".join(_text(part) for part in parts))


def _text(part: Content) -> str:
    if part is None:
        return ""
    return part.html if isinstance(part, Markup) else escape(str(part))


def _value(value: str | float | bool) -> str:
    return "" if value is True else str(value)
