"""Caps by kind in a report, and what people were off by where they marked caps again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.report.tables import number, table
from fairyring.app.review.groups import TITLES, words_of


def group_tables(groups: Mapping[str, Mapping[str, dict[str, Any]]]) -> list[Markup]:
    """A table for each kind of groups that there are caps of."""
    return [
        element("section", element("h2", title), _group(groups[kind]))
        for kind, title in TITLES.items()
        if groups[kind]
    ]


def _group(values: Mapping[str, dict[str, Any]]) -> Markup:
    head = ("", "CDR %", "Median", "95 of 100", "Floor %", "px", "Matched", "Missed", "Extra")
    rows = [
        (
            words_of(value),
            number(some["cdr"]["mean"]),
            number(some["cdr"]["median"]),
            number(some["cdr"]["p95"]),
            number(some["floor"]["cdr_mean"]),
            number(some["px"]["mean"], 2),
            some["matched"],
            some["missed"],
            some["extra"],
        )
        for value, some in values.items()
    ]
    return table(head, rows)


def marked_again(found: dict[str, Any]) -> Markup:
    """The floor from caps that were marked twice, of everybody and by kind."""
    if not found["count"]:
        told = "No cap of this project was marked again, so floors are those of the marks' geometry."
        return element("p", told, class_="quiet")
    rows = [
        (f"{kind.replace('_', ' ')}: {words_of(name)}", *_floor_row(floor))
        for kind, values in found["by"].items()
        for name, floor in values.items()
    ]
    told = (
        "From the caps of this project that were marked twice; a person's or a kind's own count "
        f"from {found['enough']} on."
    )
    whole = table(("", "Floor %", "95 of 100", "Caps"), [("all", *_floor_row(found["all"])), *rows])
    return element("section", element("p", told, class_="quiet"), whole)


def _floor_row(floor: dict[str, Any]) -> tuple[Content, ...]:
    return number(floor["mean"]), f"{number(floor['low'])}–{number(floor['high'])}", floor["count"]
