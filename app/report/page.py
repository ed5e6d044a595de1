"""The review as one HTML file: figures, plots, tables, the worst caps as pictures. It loads nothing else."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Sequence
from typing import Any

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.report.groups import group_tables, marked_again
from fairyring.app.report.heading import heading, is_of_one, title_of
from fairyring.app.report.images import image_sections
from fairyring.app.report.paper_tables import paper_tables
from fairyring.app.report.pictures import close_ups
from fairyring.app.report.plots import shifts
from fairyring.app.report.said import said_table
from fairyring.app.report.tables import number, percent
from fairyring.app.report.two_annotators import two_annotators
from fairyring.app.report.two_runs import two_runs
from fairyring.app.review.figures import Review, figures_of, worst_caps
from fairyring.app.review.said import entry_of
from fairyring.app.review.unmeasured import why_unmeasured
from fairyring.app.review.what_cdr_is import ABOUT
from fairyring.app.static_folder import STATIC
from fairyring.model.evaluate.agreement import Agreement
from fairyring.storage.project import Project


def page_of(
    project: Project,
    review: Review,
    *,
    before: Review | None = None,
    second: tuple[str, Agreement] | None = None,
) -> str:
    """The page, which says nothing that a second call would not say again.

    Args:
        project: whose photos are shown.
        review: what is reported.
        before: the same images as another run saw them, to be put beside it; None for none.
        second: what another annotator's version is called, and how far it agrees; None for none.
    """
    figures = figures_of(review)
    page = element(
        "html",
        element(
            "head",
            Markup('<meta charset="utf-8"><meta name="viewport" content="width=device-width">'),
            element("title", title_of(project, review)),
            element("style", Markup((STATIC / "report.css").read_text(encoding="utf-8"))),
        ),
        element(
            "body",
            heading(project, review),
            _totals(figures),
            element("p", ABOUT, class_="quiet"),
            two_runs(before, review) if before is not None else None,
            two_annotators(*second) if second is not None else None,
            *image_sections(project, review, figures),
            element("h2", "What reviewers said"),
            said_table(review.said, of_one=is_of_one(review)),
            paper_tables(project, review),
            *_shifts(review),
            element("h2", "What people are off by themselves"),
            marked_again(figures["marked_again"]),
            *group_tables(figures["groups"]),
            element("h2", "Worst caps" if is_of_one(review) else "Worst caps of all these images"),
            _gallery(project, review, figures),
            _untouched(review.untouched),
            _tables_to_download(figures, review),
        ),
        lang="en",
    )
    return f"<!doctype html>\n{page}\n"


def _totals(figures: dict[str, Any]) -> Markup:
    interval = figures["intervals"]["cdr"]
    mean = number(figures["cdr"]["mean"])
    told = mean if interval is None else f"{mean} ({number(interval['low'])} to {number(interval['high'])})"
    shown: tuple[tuple[str, Content], ...] = (
        ("mean CDR, %", told),
        ("floor of the marks, %", number(figures["floor"]["cdr_mean"])),
        ("mean error, px", number(figures["px"]["mean"], 2)),
        ("error / diameter, %", percent(figures["relative"]["mean"])),
        ("caps matched", figures["matched"]),
        ("missed", figures["missed"]),
        ("extra", figures["extra"]),
        ("doubtful", figures["doubtful"]),
        ("marks that hardly tell a centre", figures["unsure_marks"]),
        ("left out", figures["left_out"]),
    )
    return element(
        "dl", *(element("div", element("dd", value), element("dt", name)) for name, value in shown)
    )


def _shifts(review: Review) -> tuple[Markup, Markup]:
    found = [(error.dx, error.dy) for cap in review.caps if (error := cap.measured.error)]
    second = review.second_annotator
    if second is None:
        return element("h2", "Where predicted centres lie"), shifts(found)
    return element("h2", f"Where the centres of {second} lie"), shifts(
        found, what=f"Centre of {second} minus marked centre"
    )


def _gallery(project: Project, review: Review, figures: dict[str, Any]) -> Markup:
    worst = worst_caps(review.caps)
    if not worst:
        return element("p", why_unmeasured(figures, second=review.second_annotator), class_="quiet")
    other = review.second_annotator or "what was predicted"
    legend = f"Cyan: what people marked. Magenta: {other}. Furthest above their floor first."
    shown = []
    for cap, address in zip(worst, close_ups(project, worst), strict=True):
        row = cap.measured.row
        told = f"{row.image}, {cap.name}: CDR {number(row.cdr)}\u00a0%, {number(row.px, 1)}\u00a0px"
        told += "" if cap.floor is None else f", floor {number(cap.floor)}\u00a0%"
        picture = element("img", src=address, alt=told) if address else element("p", "The photo is gone.")
        shown.append(element("figure", picture, element("figcaption", told)))
    return element("div", element("p", legend, class_="quiet"), element("div", *shown, class_="gallery"))


def _untouched(names: Sequence[str]) -> Markup | None:
    if not names:
        return None
    told = (
        f"Nobody has worked on {names[0]}, so it counts nowhere above."
        if len(names) == 1
        else f"{len(names)} images that nobody has worked on count nowhere above: {', '.join(names)}."
    )
    return element("section", element("h2", "Not looked at yet"), element("p", told, class_="quiet"))


def _tables_to_download(figures: dict[str, Any], review: Review) -> Markup:
    images = [
        (r["file_name"], r["cdr"]["mean"], r["floor"]["cdr_mean"], r["px"]["mean"]) for r in figures["images"]
    ]
    measured = ("prediction", "dx", "dy", "px", "cdr", "relative", "diameter", "size")
    of_mark = ("floor", "annotator", "shape", "is_doubtful", "is_unsure")
    names = ("image", "cap", *measured, *(name.removeprefix("is_") for name in of_mark))
    caps = [
        [
            each.measured.row.image,
            each.measured.row.truth,
            *(getattr(each.measured.row, name) for name in measured),
            *(getattr(each, name) for name in of_mark),
        ]
        for each in review.caps
        if each.measured.truth is not None and each.measured.error
    ]
    said = [entry_of(each) for each in review.said]
    told = ("image", "annotation", "revision", "says", "words", "by", "at")
    return element(
        "p",
        _download("images.csv", ("image", "cdr", "floor", "px"), images),
        " · ",
        _download("caps.csv", names, caps),
        " · ",
        _download("verdicts.csv", told, [[entry.get(name, "") for name in told] for entry in said]),
        id="files",
    )


def _download(name: str, head: Sequence[str], rows: Sequence[Sequence[Any]]) -> Markup:
    written = io.StringIO()
    writer = csv.writer(written)
    writer.writerow(head)
    writer.writerows(rows)
    data = base64.b64encode(written.getvalue().encode()).decode()
    return element("a", name, download=name, href=f"data:text/csv;base64,{data}")
