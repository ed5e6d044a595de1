"""Plots as SVG: in a figure with a caption, or several of them below each other as one file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fairyring.app.panels.markup import Content, Markup, element


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """A plot, sizes in pixels."""

    caption: str
    width: int
    height: int
    parts: Sequence[Markup]


def figure_of(drawings: Sequence[Drawing], *more: Content) -> Markup:
    """Drawings of one caption, with ``more`` behind it."""
    caption = element("figcaption", drawings[0].caption, *more)
    return element("figure", *map(_svg, drawings), caption)


def file_of(drawings: Sequence[Drawing], looks: str) -> str:
    """Drawings below each other as one SVG file, with their looks in it."""
    width = max((each.width for each in drawings), default=0)
    above = [sum(each.height for each in drawings[:nth]) for nth in range(len(drawings) + 1)]
    svg = element(
        "svg",
        element("style", Markup(looks)),
        *(_svg(each, y=y) for each, y in zip(drawings, above, strict=False)),
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {above[-1]}",
        width=width,
        height=above[-1],
    )
    return svg.html


def _svg(of: Drawing, *, y: int | None = None) -> Markup:
    return element(
        "svg",
        *of.parts,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {of.width} {of.height}",
        width=of.width,
        height=of.height,
        y=y,
        role="img",
        aria_label=of.caption,
    )
