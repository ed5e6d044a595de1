"""Annotations against predictions: figures of all images and of groups of them, and image by image."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import get_args

from sqlalchemy import Connection

from fairyring.app.addresses import review_address
from fairyring.app.jobs.comparing import compare_work
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import EMPTY, Markup, element
from fairyring.app.panels.status import run_badge
from fairyring.app.review.what_cdr_is import ABOUT
from fairyring.storage.compared_caps import Kind
from fairyring.storage.comparisons import ComparisonRow, ComparisonSort, list_comparisons, stale_images
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Run
from fairyring.storage.review_figures import By, Totals, totals, totals_by, untouched

PAGE = 10
FIRST = -1.0
"""Place in the page before all that has no other."""
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
    groups: Mapping[str, Totals] = field(default_factory=dict)
    rows: list[ComparisonRow] = field(default_factory=list)
    first: int = 0
    """Place of the first row among all."""
    total: int = 0
    stale: int = 0
    untouched: tuple[int, list[str]] = (0, [])


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the review of the latest run."""
    gui = session.client.gui
    figures = gui.add_html("", order=FIRST)
    shown = gui.add_html("")
    compare = gui.add_button("Bring up to date", visible=False)
    order = gui.add_dropdown("Order", tuple(ORDERS))
    by = gui.add_dropdown("Figures by", tuple(GROUPS))
    only_sure = gui.add_checkbox(
        "Sure marks only",
        initial_value=False,
        hint="Without doubtful caps and marks that hardly tell a centre",
    )
    pages = gui.add_button_group("Page", ("‹", "›"))
    page = [0]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.redraw_at_once(("review",))

    async def choose() -> None:
        page[0] = 0
        session.only_sure = only_sure.value
        session.redraw_at_once(("review", "plots", "cap_plot"))

    async def start() -> None:
        workspace.start_job(session, "Comparison with the predictions", compare_work(workspace.project))

    async def redraw() -> None:
        wanted = Wanted(
            order=order.value,
            by=GROUPS[by.value],
            only_sure=session.only_sure,
            run=session.run_on_photo,
            page=page[0],
        )
        review = await workspace.read(partial(find_review, wanted=wanted))
        page[0] = review.first // PAGE
        figures.content = review_figures(review).html
        shown.content = review_page(review, session.image.id if session.image else None, wanted).html
        pages.visible = review.total > PAGE
        compare.visible = review.stale > 0

    for control in (order, by, only_sure):
        control.on_update(person_did(session, choose))
    pages.on_click(person_did(session, turn))
    compare.on_click(person_did(session, start))
    return redraw


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
    by = wanted.by
    return Review(
        run=run,
        totals=totals(connection, run.id, only_sure=wanted.only_sure),
        groups=totals_by(connection, run.id, by, only_sure=wanted.only_sure) if by else {},
        rows=found.rows,
        first=first,
        total=found.total,
        stale=len(stale_images(connection, run.id)),
        untouched=untouched(connection),
    )


def review_figures(review: Review) -> Markup:
    """What stands first: whose predictions, and the figures of all images."""
    if review.run is None or review.totals is None or not review.rows:
        return EMPTY
    return element(
        "div",
        element("div", run_badge(review.run), _stale_note(review.stale), class_="fr-line"),
        _totals(review.totals),
        element("details", element("summary", "What CDR is"), element("p", ABOUT), class_="fr-quiet"),
        class_="fr-review",
    )


def review_page(review: Review, current: int | None, wanted: Wanted = USUAL) -> Markup:
    """Groups of caps, and a page of the images; or why there is nothing yet."""
    if review.run is None:
        return _hint("No predictions yet; there is nothing to compare with.")
    if not review.rows and review.stale:
        return _hint(f"{review.stale} images have not been compared with the predictions yet.")
    if not review.rows or review.totals is None:
        return _hint(
            "Correct some caps and mark their centres: then this compares them with the predictions."
        )
    last = review.first + len(review.rows)
    return element(
        "div",
        _groups(review.groups),
        element(
            "table",
            _head(),
            element("tbody", *(_row(row, current) for row in review.rows)),
            class_="fr-list",
        ),
        element("div", f"{review.first + 1}–{last} of {review.total} images", class_="fr-quiet"),
        _untouched(review.untouched),
        _reports(current, wanted),
        class_="fr-review",
    )


def _reports(current: int | None, wanted: Wanted) -> Markup:
    """Links to the review as a page that can be printed, against the run that was chosen for the photo."""
    of = partial(review_address, "report.html", only_sure=wanted.only_sure, run=wanted.run and wanted.run.id)
    against = f" against {wanted.run.name}" if wanted.run else ""
    links = {f"Report of all images{against}": of()}
    if current is not None:
        links[f"Report of this image{against}"] = of(image=current)
    return element(
        "div",
        *(element("a", words, href=to, target="_blank") for words, to in links.items()),
        class_="fr-line",
    )


def _untouched(found: tuple[int, list[str]]) -> Markup | None:
    """Images that nobody has worked on; every prediction on them would count as extra."""
    count, names = found
    if not count:
        return None
    more = f" and {count - len(names)} more" if count > len(names) else ""
    told = f"{count} images that nobody has worked on count nowhere here"
    return element(
        "details", element("summary", told), element("p", ", ".join(names) + more), class_="fr-quiet"
    )


def _hint(sentence: str) -> Markup:
    return element("div", sentence, class_="fr-review fr-quiet")


def _stale_note(stale: int) -> Markup | None:
    if not stale:
        return None
    return element(
        "span", f"{stale} out of date", class_="fr-badge fr-warn", title="Edited since they were compared"
    )


def _totals(found: Totals) -> Markup:
    shift = "–" if found.dx is None or found.dy is None else f"{found.dx:+.2f}, {found.dy:+.2f}"
    shown = (
        ("mean CDR", _with_percent(found.cdr)),
        ("floor of marks", _with_percent(found.floor)),
        ("Δx, Δy, px", shift),
        ("matched", found.matched),
        ("missed", _counted("missed", found.missed)),
        ("extra", _counted("extra", found.extra)),
    )
    return element(
        "dl",
        *(element("div", element("dd", value), element("dt", name)) for name, value in shown),
        class_="fr-totals",
        title=ABOUT,
    )


def _groups(groups: Mapping[str, Totals]) -> Markup | None:
    if not groups:
        return None
    titles = ("", "CDR %", "Floor %", "Caps", "Missed")
    head = element("tr", *(element("th", title, class_="fr-number" if title else None) for title in titles))
    rows = (
        element(
            "tr",
            element("td", name.replace("_", " ")),
            *(
                element("td", number, class_="fr-number")
                for number in (_percent(of.cdr), _percent(of.floor), of.measured, of.missed)
            ),
        )
        for name, of in groups.items()
    )
    return element(
        "table",
        element("thead", head),
        element("tbody", *rows),
        class_="fr-list fr-groups",
        aria_label="Groups of caps",
    )


def _counted(kind: Kind, count: int) -> Markup:
    """A number that leads to what it counts."""
    return element("button", count, type="button", class_="fr-counted", data_fairyring_gallery=kind)


def _head() -> Markup:
    titles = ("Image", "Mean %", "Floor %", "Worst %", "Missed", "Extra")
    cells = (
        element("th", t, class_=None if t == "Image" else "fr-number", width=None if t == "Image" else 50)
        for t in titles
    )
    return element("thead", element("tr", *cells))


def _row(row: ComparisonRow, current: int | None) -> Markup:
    figures = row.comparison
    told = f"{figures.caps} caps, CDR {_percent(figures.cdr_mean)} %{_floor(row)}"
    told += "; edited since it was compared" if row.stale else ""
    numbers = (
        _percent(figures.cdr_mean),
        _percent(figures.floor_mean),
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


def _with_percent(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f} %"
