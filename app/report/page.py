"""The review as one HTML file: figures, plots, tables, the worst caps as pictures. It loads nothing else."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Sequence
from typing import Any

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.panels.status import STATUS_WORDS
from fairyring.app.report.paper_tables import paper_tables
from fairyring.app.report.pictures import close_ups, side_by_side
from fairyring.app.report.plots import Bar, cdr_bars, shifts
from fairyring.app.report.tables import number, percent, table
from fairyring.app.report.two_runs import two_runs
from fairyring.app.review.figures import Review, ReviewedCap, figures_of, worst_caps
from fairyring.app.static_folder import STATIC
from fairyring.storage.project import Project

ABOUT = (
    "CDR is how far a predicted centre lies from the marked one, as a percentage of the image's width and "
    "height added up (Eq. 10 of the paper): the same error is a smaller CDR on a larger image, so pixels and "
    "shares of the cap's diameter stand beside it. The floor is the CDR that the marks have by themselves, "
    "as no hand places a point exactly: a network near it cannot be told to be wrong."
)
MOST_CAP_BY_CAP = 6
"""Of so many images at most the CDR of each cap is plotted; of more there is a bar for each image."""
GROUP_TITLES = {
    "size": "By size",
    "visibility": "By how much is in sight",
    "light": "By light",
    "form": "By form",
    "annotator": "By annotator",
}


def page_of(project: Project, review: Review, *, before: Review | None = None) -> str:
    """The page, which says nothing that a second call would not say again.

    Args:
        project: whose photos are shown.
        review: what is reported.
        before: the same images as another run saw them, to be put beside it; None for none.
    """
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
            two_runs(before, review) if before is not None else None,
            element("h2", "CDR by image"),
            cdr_bars(_bars_of_images(figures["images"]), what="Mean CDR by image"),
            _images(figures["images"]),
            *_cap_by_cap(review),
            *_photos(project, review),
            paper_tables(project, review),
            element("h2", "Where predicted centres lie"),
            shifts([(cap.dx, cap.dy) for cap in (c.measured.error for c in review.caps) if cap]),
            element("h2", "What people are off by themselves"),
            _marked_again(figures["marked_again"]),
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


def _images(images: Sequence[dict[str, Any]]) -> Markup:
    head = ("Image", "Status", "CDR %", "Floor %", "px", "Matched", "Missed", "Extra")
    rows = [
        (
            row["file_name"],
            STATUS_WORDS[row["status"]],
            number(row["cdr"]["mean"]),
            number(row["floor"]["cdr_mean"]),
            number(row["px"]["mean"], 2),
            row["matched"],
            row["missed"],
            row["extra"],
        )
        for row in images
    ]
    return table(head, rows)


def _bars_of_images(images: Sequence[dict[str, Any]]) -> list[Bar]:
    """The highest first."""
    bars = [
        Bar(name=row["file_name"], cdr=row["cdr"]["mean"], floor=row["floor"]["cdr_mean"])
        for row in images
        if row["cdr"]["mean"] is not None
    ]
    return sorted(bars, key=lambda bar: bar.cdr, reverse=True)


def _cap_by_cap(review: Review) -> list[Markup]:
    """CDR of each cap of each of a few images, as the paper's Figure 19."""
    if len(review.images) > MOST_CAP_BY_CAP:
        return []
    plots = [element("h2", "CDR of each cap")]
    for place, image in enumerate(review.images):
        caps = [cap for cap in review.caps if cap.measured.page == place and cap.measured.error]
        plots.append(cdr_bars(_bars_of_caps(caps), what=f"{image.file_name}: CDR of each cap"))
    return plots


def _photos(project: Project, review: Review) -> list[Markup]:
    """What was marked, what was predicted, and both, of a few photos."""
    if len(review.images) > MOST_CAP_BY_CAP:
        return []
    shown = []
    for image in review.images:
        words = ("marked", "predicted", "both, with the lines between centres")
        pictures = zip(words, side_by_side(project, image.id), strict=False)
        shown += [_photo(f"{image.file_name}: {word}", address) for word, address in pictures]
    return [element("h2", "Marked and predicted contours"), *shown] if shown else []


def _photo(told: str, address: str) -> Markup:
    picture = element("img", src=address, alt=told)
    return element("figure", picture, element("figcaption", told), class_="photo")


def _bars_of_caps(caps: Sequence[ReviewedCap]) -> list[Bar]:
    errors = [(cap, cap.measured.error) for cap in caps]
    return [
        Bar(name=f"cap {nth}", cdr=error.cdr, floor=cap.floor)
        for nth, (cap, error) in enumerate(errors, start=1)
        if error
    ]


def _marked_again(found: dict[str, Any]) -> Markup:
    """The floor from caps that were marked twice, of everybody and by kind."""
    if not found["count"]:
        return element(
            "p", "No cap was marked again, so floors are those of the marks' geometry.", class_="quiet"
        )
    rows = [
        (f"{kind.replace('_', ' ')}: {name.replace('_', ' ')}", *_floor_row(floor))
        for kind, values in found["by"].items()
        for name, floor in values.items()
    ]
    told = f"From caps marked twice; a person's or a kind's own count from {found['enough']} on."
    whole = table(("", "Floor %", "95 of 100", "Caps"), [("all", *_floor_row(found["all"])), *rows])
    return element("section", element("p", told, class_="quiet"), whole)


def _floor_row(floor: dict[str, Any]) -> tuple[Content, ...]:
    return number(floor["mean"]), f"{number(floor['low'])}–{number(floor['high'])}", floor["count"]


def _group(title: str, values: dict[str, dict[str, Any]]) -> Markup | None:
    if not values:
        return None
    head = ("", "CDR %", "Median", "95 of 100", "Floor %", "px", "Matched", "Missed")
    rows = [
        (
            value.replace("_", " "),
            number(some["cdr"]["mean"]),
            number(some["cdr"]["median"]),
            number(some["cdr"]["p95"]),
            number(some["floor"]["cdr_mean"]),
            number(some["px"]["mean"], 2),
            some["matched"],
            some["missed"],
        )
        for value, some in values.items()
    ]
    return element("section", element("h2", title), table(head, rows))


def _gallery(project: Project, review: Review) -> Markup:
    worst = worst_caps(review.caps)
    if not worst:
        return element("p", "No marked cap was predicted.", class_="quiet")
    legend = "Cyan: what people marked. Magenta: what was predicted. Furthest above their floor first."
    figures = []
    for cap, address in zip(worst, close_ups(project, worst), strict=True):
        row = cap.measured.row
        told = f"{row.image}: CDR {number(row.cdr)} %, {number(row.px, 1)} px"
        told += "" if cap.floor is None else f", floor {number(cap.floor)} %"
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
