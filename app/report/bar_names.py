"""The names below the bars of a plot: side by side where there is room, else upright."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.panels.markup import Markup, element

LETTER = 6.2
"""Width of a letter of a name, pixels."""
LONGEST = 28
"""Letters of a name at most; longer ones lose their middle."""
MARGIN = 12
LINE = 20
"""Height of a line of names, pixels."""


def room_for(names: Sequence[str], *, step: float) -> int:
    """How much room, pixels, the names of bars need that stand ``step`` pixels apart."""
    longest = max((len(_cut(name)) for name in names), default=0)
    return LINE if _lie(names, step) else round(longest * LETTER) + MARGIN


def bar_names(names: Sequence[str], *, left: float, top: float, step: float) -> list[Markup]:
    """The names below an axis at ``top``, the first bar beginning at ``left``."""
    lie = _lie(names, step)
    return [_name(name, left + (nth + 0.5) * step, top, lie=lie) for nth, name in enumerate(names)]


def _name(name: str, x: float, top: float, *, lie: bool) -> Markup:
    shown = _cut(name)
    if lie:
        return element("text", shown, x=round(x, 1), y=top + 15, class_="name")
    at = round(x + 3.5, 1), top + 6
    return element(
        "text", shown, x=at[0], y=at[1], class_="name upright", transform=f"rotate(-90 {at[0]} {at[1]})"
    )


def _lie(names: Sequence[str], step: float) -> bool:
    return all(len(_cut(name)) * LETTER < step - 2 for name in names)


def _cut(name: str) -> str:
    half = LONGEST // 2
    return name if len(name) <= LONGEST else f"{name[: half - 1]}…{name[-half:]}"
