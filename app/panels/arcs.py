"""The pieces of the selected cap's rim: what each was taken for, and a choice of what it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fairyring.app.panels.markup import Markup, element
from fairyring.app.protocol import Arc
from fairyring.model.contour.result import ArcKind
from fairyring.model.geometry.shapes import Points, points_of_part
from fairyring.model.geometry.told_arcs import TOLD_KINDS

WORDS: dict[ArcKind, str] = {
    "visible": "own rim",
    "hidden": "behind a neighbour",
    "border": "cut off",
    "contact": "touching",
    "concave": "hollow",
}
PLACES = ("right", "below right", "below", "below left", "left", "above left", "above", "above right")
"""By eighths of a turn from +x towards +y."""


def arcs_list(arcs: Sequence[Arc]) -> Markup:
    """A choice for each piece; the editor says what was chosen."""
    lines = [points_of_part(arc.points) for arc in arcs]
    middle = np.concatenate(lines).mean(axis=0)
    whole = sum(map(len, lines))
    rows = (
        element(
            "label",
            element("span", _where(line, middle, share=len(line) / whole)),
            _choice(arc),
        )
        for arc, line in zip(arcs, lines, strict=True)
    )
    return element("div", *rows, class_="fr-arcs")


def _where(line: Points, middle: Points, *, share: float) -> str:
    if share == 1:
        return "all round"
    x, y = line[len(line) // 2] - middle
    place = PLACES[round(np.degrees(np.arctan2(y, x)) / 45) % len(PLACES)]
    return f"{place}, {share:.0%}".replace("%", " %")


def _choice(arc: Arc) -> Markup:
    as_found = "as worked out" if arc.told else WORDS[arc.kind]
    options = [element("option", as_found, value="", selected=not arc.told)]
    options += [
        element("option", f"{WORDS[kind]} (said)", value=kind, selected=arc.told and arc.kind == kind)
        for kind in TOLD_KINDS
    ]
    x, y = arc.points[:2]
    return element(
        "select", *options, data_fairyring_arc=f"{_number(x)},{_number(y)}", title="What this piece is"
    )


def _number(value: float) -> str:
    """As a browser writes it."""
    return f"{value:.2f}".rstrip("0").rstrip(".")
