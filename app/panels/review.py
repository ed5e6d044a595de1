"""Annotations against predictions, image by image: figures, two plots, and the worst first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

from sqlalchemy import Connection

from fairyring.app.jobs.comparing import compare_work
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import run_badge
from fairyring.storage.compared_caps import Kind
from fairyring.storage.comparisons import ComparisonRow, ComparisonSort, list_comparisons, stale_images
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Run

PAGE = 10
MOST_IMAGES = 2000
"""Images that the figures and plots cover; with more, those first in the order asked for."""
MOST_BARS = 60
ABOUT_FLOOR = (
    "The floor is the CDR that the marks have by themselves, as no hand places a point exactly: "
    "predictions near it cannot be told to be wrong."
)
ORDERS: dict[str, tuple[ComparisonSort, bool]] = {
    "worst cap first": ("cdr_worst", True),
    "highest mean first": ("cdr_mean", True),
    "most missed first": ("missed", True),
    "most extra first": ("extra", True),
    "most caps first": ("caps", True),
    "name": ("name", False),
}
assert {sort for sort, _ in ORDERS.values()} <= set(get_args(ComparisonSort))


@dataclass(frozen=True)
class Review:
    """The comparisons of the latest run, in the order asked for."""

    run: Run | None
    rows: list[ComparisonRow]
    total: int
    stale: int


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the review of the latest run."""
    gui = session.client.gui
    order = gui.add_dropdown("Order", tuple(ORDERS))
    shown = gui.add_html("")
    pages = gui.add_button_group("Page", ("‹", "›"))
    compare = gui.add_button("Bring up to date", visible=False)
    page = [0]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.refresh("review")

    async def reorder() -> None:
        page[0] = 0
        session.refresh("review")

    async def start() -> None:
        workspace.start_job(session, "Comparison with the predictions", compare_work(workspace.project))

    async def redraw() -> None:
        sort, descending = ORDERS[order.value]
        review = await workspace.read(lambda connection: _load(connection, sort, descending))
        page[0] = min(page[0], max(len(review.rows) - 1, 0) // PAGE)
        here = session.image.id if session.image else None
        shown.content = review_page(review, page[0], here).html
        pages.visible = len(review.rows) > PAGE
        compare.visible = review.stale > 0

    order.on_update(person_did(session, reorder))
    pages.on_click(person_did(session, turn))
    compare.on_click(person_did(session, start))
    return redraw


def _load(connection: Connection, sort: ComparisonSort, descending: bool) -> Review:
    run = latest_run(connection)
    if run is None:
        return Review(None, [], 0, 0)
    page = list_comparisons(connection, run.id, sort=sort, descending=descending, limit=MOST_IMAGES)
    return Review(run, page.rows, page.total, len(stale_images(connection, run.id)))


def review_page(review: Review, number: int, current: int | None) -> Markup:
    """Figures, plots, and a page of the table."""
    if review.run is None:
        return _hint("No predictions yet; there is nothing to compare with.")
    if not review.rows and review.stale:
        return _hint(f"{review.stale} images have not been compared with the predictions yet.")
    if not review.rows:
        return _hint(
            "Correct some caps and mark their centres: then this compares them with the predictions."
        )
    first = number * PAGE
    rows = review.rows[first : first + PAGE]
    return element(
        "div",
        element("div", run_badge(review.run), _stale_note(review.stale), class_="fr-line"),
        _totals(review.rows),
        _bars(review.rows[:MOST_BARS], current),
        element("table", _head(), element("tbody", *(_row(row, current) for row in rows)), class_="fr-list"),
        element("div", f"{first + 1}–{first + len(rows)} of {review.total} images", class_="fr-quiet"),
        _scatter(review.rows),
        class_="fr-review",
    )


def _hint(sentence: str) -> Markup:
    return element("div", sentence, class_="fr-review fr-quiet")


def _stale_note(stale: int) -> Markup | None:
    if not stale:
        return None
    return element(
        "span", f"{stale} out of date", class_="fr-badge fr-warn", title="Edited since they were compared"
    )


def _totals(rows: list[ComparisonRow]) -> Markup:
    figures = [row.comparison for row in rows]
    counted = [(f, min(f.marked, f.matched)) for f in figures]
    mean = _weighted([(f.cdr_mean, count) for f, count in counted])
    floor = _weighted([(f.floor_mean, count) for f, count in counted])
    totals = (
        ("mean CDR", "–" if mean is None else f"{mean:.3f} %"),
        ("floor of marks", "–" if floor is None else f"{floor:.3f} %"),
        ("marked", sum(f.marked for f in figures)),
        ("matched", sum(f.matched for f in figures)),
        ("missed", _counted("missed", sum(f.missed for f in figures))),
        ("extra", _counted("extra", sum(f.extra for f in figures))),
    )
    return element(
        "dl",
        *(element("div", element("dd", value), element("dt", name)) for name, value in totals),
        class_="fr-totals",
        title=ABOUT_FLOOR,
    )


def _counted(kind: Kind, count: int) -> Markup:
    """A number that leads to what it counts."""
    return element("button", count, type="button", class_="fr-counted", data_fairyring_gallery=kind)


def _weighted(figures: list[tuple[float | None, int]]) -> float | None:
    """The mean of those figures that are known, each counted so many times."""
    known = [(figure, count) for figure, count in figures if figure is not None]
    weight = sum(count for _, count in known)
    return sum(figure * count for figure, count in known) / weight if weight else None


def _bars(rows: list[ComparisonRow], current: int | None) -> Markup | None:
    measured = [row for row in rows if row.comparison.cdr_worst]
    top = max((row.comparison.cdr_worst or 0.0 for row in measured), default=0.0)
    if not top:
        return None
    return element(
        "figure",
        element("figcaption", f"CDR per image: mean, and the worst cap (up to {top:.2f} %)"),
        element("div", *(_bar(row, top, current) for row in measured), class_="fr-bars"),
    )


def _bar(row: ComparisonRow, top: float, current: int | None) -> Markup:
    figures = row.comparison
    mean, worst = figures.cdr_mean or 0.0, figures.cdr_worst or 0.0
    return element(
        "button",
        element("span", style=f"height: {100 * worst / top:.1f}%", class_="fr-bar-worst"),
        element("span", style=f"height: {100 * mean / top:.1f}%", class_="fr-bar-mean"),
        type="button",
        title=f"{row.file_name}: mean {mean:.3f} %{_floor(row)}, worst {worst:.3f} %",
        aria_label=f"Open {row.file_name} at its worst cap",
        aria_current="true" if figures.image == current else None,
        **_opens(row),
    )


def _scatter(rows: list[ComparisonRow]) -> Markup | None:
    points = [(row, row.comparison.dx, row.comparison.dy) for row in rows]
    measured = [(row, dx, dy) for row, dx, dy in points if dx is not None and dy is not None]
    if not measured:
        return None
    reach = 1.15 * max(0.5, *(max(abs(dx), abs(dy)) for _, dx, dy in measured))
    dots = [
        element(
            "button",
            type="button",
            style=f"left: {50 + 50 * dx / reach:.1f}%; top: {50 + 50 * dy / reach:.1f}%",
            title=f"{row.file_name}: Δx {dx:+.2f}, Δy {dy:+.2f} px",
            aria_label=f"Open {row.file_name} at its worst cap",
            **_opens(row),
        )
        for row, dx, dy in measured
    ]
    caption = f"Mean shift per image, predicted minus marked; edges at ±{reach:.2f} px"
    return element("figure", element("figcaption", caption), element("div", *dots, class_="fr-scatter"))


def _head() -> Markup:
    titles = ("Image", "Caps", "Mean %", "Worst %", "Missed", "Extra")
    cells = (
        element("th", t, class_=None if t == "Image" else "fr-number", width=None if t == "Image" else 50)
        for t in titles
    )
    return element("thead", element("tr", *cells))


def _row(row: ComparisonRow, current: int | None) -> Markup:
    figures = row.comparison
    told = f"CDR {_percent(figures.cdr_mean)} %{_floor(row)}"
    told += "; edited since it was compared" if row.stale else ""
    numbers = (
        str(figures.caps),
        _percent(figures.cdr_mean),
        _percent(figures.cdr_worst),
        str(figures.missed),
        str(figures.extra),
    )
    name = element("span", row.file_name, class_="fr-ellipsis", title=row.file_name)
    return element(
        "tr",
        element("td", name),
        *(element("td", number, class_="fr-number") for number in numbers),
        class_="fr-stale" if row.stale else None,
        title=told,
        aria_current="true" if figures.image == current else None,
        tabindex=0,
        role="button",
        **_opens(row),
    )


def _floor(row: ComparisonRow) -> str:
    floor = row.comparison.floor_mean
    return "" if floor is None else f" (the marks alone {floor:.3f} %)"


def _opens(row: ComparisonRow) -> dict[str, str | float | bool | None]:
    return {"data_fairyring_open": row.comparison.image, "data_fairyring_select": row.comparison.worst}


def _percent(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"
