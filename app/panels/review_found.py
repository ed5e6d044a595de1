"""What a person asks to see of a review, and what is found of it in the store."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import get_args

from sqlalchemy import Connection

from fairyring.app.review.groups import NOT_KNOWN, in_order
from fairyring.storage.cap_groups import By
from fairyring.storage.comparisons import ComparisonRow, ComparisonSort, list_comparisons, stale_images
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Run
from fairyring.storage.review_figures import Totals, marked_caps, totals, totals_by, untouched
from fairyring.storage.runs import all_runs

PAGE = 10
ORDERS: dict[str, tuple[ComparisonSort, bool]] = {
    "worst cap first": ("cdr_worst", True),
    "highest mean first": ("cdr_mean", True),
    "most missed first": ("missed", True),
    "most extra first": ("extra", True),
    "most caps first": ("caps", True),
    "name": ("name", False),
}
assert {sort for sort, _ in ORDERS.values()} <= set(get_args(ComparisonSort))
GROUPS: dict[str, By | None] = {
    "nothing": None,
    "annotator": "annotator",
    "size": "size",
    "visible share": "visibility",
    "circle or polygon": "shape",
    "light": "light",
    "form": "form",
    "run": "run",
}


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What a person asks to see."""

    order: str = "worst cap first"
    by: By | None = None
    only_sure: bool = False
    run: Run | None = None
    """Whom reports are to be held against; None for the latest run of each image."""
    page: int = 0


USUAL = Wanted()


@dataclass(frozen=True, kw_only=True)
class Review:
    """The figures of the latest run, and the page of the images asked for."""

    run: Run | None
    totals: Totals | None = None
    marked: int = 0
    """Caps whose mark gives a centre, on all images."""
    groups: Mapping[str, Totals] = field(default_factory=dict)
    """By value, in the order in which they are shown; runs by their number."""
    names_of_runs: Mapping[str, str] = field(default_factory=dict)
    rows: list[ComparisonRow] = field(default_factory=list)
    first: int = 0
    """Place of the first row among all."""
    total: int = 0
    stale: int = 0
    untouched: tuple[int, list[str]] = (0, [])


def find_review(connection: Connection, *, wanted: Wanted) -> Review:
    """The figures of the latest run, and the page asked for, or the last one."""
    run = latest_run(connection)
    if run is None:
        return Review(run=None)
    sort, descending = ORDERS[wanted.order]
    find = partial(
        list_comparisons,
        connection,
        run.id,
        sort=sort,
        descending=descending,
        only_sure=wanted.only_sure,
        limit=PAGE,
    )
    found, first = find(offset=wanted.page * PAGE), wanted.page * PAGE
    if not found.rows and found.total:
        first = (found.total - 1) // PAGE * PAGE
        found = find(offset=first)
    return Review(
        run=run,
        totals=totals(connection, run.id, only_sure=wanted.only_sure),
        marked=marked_caps(connection, run.id),
        groups=_groups(connection, run.id, wanted),
        names_of_runs=_names_of_runs(connection, wanted),
        rows=found.rows,
        first=first,
        total=found.total,
        stale=len(stale_images(connection, run.id)),
        untouched=untouched(connection),
    )


def _groups(connection: Connection, run_id: int, wanted: Wanted) -> dict[str, Totals]:
    """Figures by value, in an order that means something; runs by number, the latest first."""
    if wanted.by is None:
        return {}
    found = totals_by(connection, run_id, wanted.by, only_sure=wanted.only_sure)
    if wanted.by == "run":
        return {value: found[value] for value in sorted(filter(None, found), key=int, reverse=True)}
    named = {NOT_KNOWN if value is None else value: of for value, of in found.items()}
    return in_order(wanted.by, named, cdr=lambda of: of.cdr)


def _names_of_runs(connection: Connection, wanted: Wanted) -> dict[str, str]:
    return {str(run.id): run.name for run in all_runs(connection)} if wanted.by == "run" else {}
