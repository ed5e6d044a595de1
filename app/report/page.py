"""The review as one HTML file: figures, plots, tables, the worst caps as pictures. It loads nothing else."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Sequence
from typing import Any

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.panels.status import STATUS_WORDS
from fairyring.app.report.pictures import close_ups
from fairyring.app.report.plots import cdr_by_image, shifts
from fairyring.app.review.figures import Review, figures_of, worst_caps
from fairyring.app.static_folder import STATIC
from fairyring.storage.project import Project

ABOUT = (
    "CDR is how far a predicted centre lies from the marked one, as a percentage of the image's width and "
    "height added up (Eq. 10 of the paper): the same error is a smaller CDR on a larger image, so pixels and "
    "shares of the cap's diameter stand beside it. The floor is the CDR that the marks have by themselves, "
    "as no hand places a point exactly: a network near it cannot be told to be wrong."
)
GROUP_TITLES = {
    "size": "By size",
    "visibility": "By how much is in sight",
    "light": "By light",
    "form": "By form",
    "annotator": "By annotator",
}


def page_of(project: Project, review: Review) -> str:
    """The page, which says nothing that a second run would not say again."""
    figures = figures_of(review)
    page = element(
        "html",
        element(
            "head",
            Markup('<meta charset="utf-8"><meta name="viewport" content="width=device-width">'),
            element("title", f"Review of {project.name}"),
            element("style", Markup((STATIC / "report.css").read_text(encoding="utf-8"))),
        ),
        element(
            "body",
            element("h1", f"Review of {project.name}"),
            _totals(figures),
            element("p", ABOUT, class_="quiet"),
            element("h2", "CDR by image"),
            cdr_by_image(figures["images"]),
            _images(figures["images"]),
            element("h2", "Where predicted centres lie"),
            shifts(review.caps),
            *(_group(title, figures["groups"][kind]) for kind, title in GROUP_TITLES.items()),
            element("h2", "Worst caps of all images"),
            _gallery(project, review),
            _untouched(review.untouched),
            _tables_to_download(figures, review),
        ),
        lang="en",
    )
    return f"<!doctype html>\n{page}\n"


def _totals(figures: dict[str, Any]) -> Markup:
    interval = figures["intervals"]["cdr"]
    mean = _number(figures["cdr"]["mean"])
    told = mean if interval is None else f"{mean} ({_number(interval['low'])} to {_number(interval['high'])})"
    shown: tuple[tuple[str, Content], ...] = (
        ("mean CDR, %", told),
        ("floor of the marks, %", _number(figures["floor"]["cdr_mean"])),
        ("mean error, px", _number(figures["px"]["mean"], 2)),
        ("error / diameter, %", _percent(figures["relative"]["mean"])),
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


def _images(images: Sequence[dict[str, Any]]) -> Markup:
    head = ("Image", "Status", "CDR %", "Floor %", "px", "Matched", "Missed", "Extra")
    rows = [
        (
            row["file_name"],
            STATUS_WORDS[row["status"]],
            _number(row["cdr"]["mean"]),
            _number(row["floor"]["cdr_mean"]),
            _number(row["px"]["mean"], 2),
            row["matched"],
            row["missed"],
            row["extra"],
        )
        for row in images
    ]
    return _table(head, rows)


def _group(title: str, values: dict[str, dict[str, Any]]) -> Markup | None:
    if not values:
        return None
    head = ("", "CDR %", "Median", "95 of 100", "Floor %", "px", "Matched", "Missed")
    rows = [
        (
            value.replace("_", " "),
            _number(some["cdr"]["mean"]),
            _number(some["cdr"]["median"]),
            _number(some["cdr"]["p95"]),
            _number(some["floor"]["cdr_mean"]),
            _number(some["px"]["mean"], 2),
            some["matched"],
            some["missed"],
        )
        for value, some in values.items()
    ]
    return element("section", element("h2", title), _table(head, rows))


def _gallery(project: Project, review: Review) -> Markup:
    worst = worst_caps(review.caps)
    if not worst:
        return element("p", "No marked cap was predicted.", class_="quiet")
    legend = "Cyan: what people marked. Magenta: what was predicted. Furthest above their floor first."
    figures = []
    for cap, address in zip(worst, close_ups(project, worst), strict=True):
        row = cap.measured.row
        told = f"{row.image}: CDR {_number(row.cdr)} %, {_number(row.px, 1)} px"
        told += "" if cap.floor is None else f", floor {_number(cap.floor)} %"
        picture = element("img", src=address, alt=told) if address else element("p", "The photo is gone.")
        figures.append(element("figure", picture, element("figcaption", told)))
    return element("div", element("p", legend, class_="quiet"), element("div", *figures, class_="gallery"))


def _untouched(names: Sequence[str]) -> Markup | None:
    if not names:
        return None
    told = f"{len(names)} images that nobody has worked on count nowhere above: {', '.join(names)}."
    return element("section", element("h2", "Not looked at yet"), element("p", told, class_="quiet"))


def _tables_to_download(figures: dict[str, Any], review: Review) -> Markup:
    images = [
        (r["file_name"], r["cdr"]["mean"], r["floor"]["cdr_mean"], r["px"]["mean"]) for r in figures["images"]
    ]
    rows = [cap.measured.row for cap in review.caps if cap.measured.error]
    caps = [(r.image, r.truth, r.prediction, r.dx, r.dy, r.px, r.cdr, r.relative, r.diameter) for r in rows]
    names = ("image", "cap", "prediction", "dx", "dy", "px", "cdr", "relative", "diameter")
    return element(
        "p",
        _download("images.csv", ("image", "cdr", "floor", "px"), images),
        " · ",
        _download("caps.csv", names, caps),
    )


def _download(name: str, head: Sequence[str], rows: Sequence[Sequence[Any]]) -> Markup:
    written = io.StringIO()
    writer = csv.writer(written)
    writer.writerow(head)
    writer.writerows(rows)
    data = base64.b64encode(written.getvalue().encode()).decode()
    return element("a", name, download=name, href=f"data:text/csv;base64,{data}")


def _table(head: Sequence[str], rows: Sequence[Sequence[Content]]) -> Markup:
    return element(
        "table",
        element("thead", element("tr", *(element("th", title) for title in head))),
        element("tbody", *(element("tr", *(element("td", value) for value in row)) for row in rows)),
    )


def _number(value: float | None, decimals: int = 3) -> str:
    return "–" if value is None else f"{value:.{decimals}f}"


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{100 * share:.2f}"
