"""Image by image in a report: figures and bars, and of a few images every cap and the photos themselves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import status_word
from fairyring.app.report.bars import Bar, cdr_bars
from fairyring.app.report.pictures import side_by_side
from fairyring.app.report.tables import number, table
from fairyring.app.review.figures import Review
from fairyring.app.review.unmeasured import why_unmeasured
from fairyring.storage.project import Project
from fairyring.storage.verdicts import given_back

MOST_CAP_BY_CAP = 6
"""Of so many images at most each cap is plotted, and the photo shown."""


def image_sections(project: Project, review: Review, figures: dict[str, Any]) -> list[Markup]:
    """What there is of each image; of a single one no plot that would compare it with others."""
    images = figures["images"]
    few = len(review.images) <= MOST_CAP_BY_CAP
    return [
        element("h2", "Image by image" if len(images) > 1 else "The image"),
        *([_bars_of_images(review, images, figures)] if len(images) > 1 else []),
        _table(images, _status_words(project, review)),
        *(_cap_by_cap(review, images) if few else []),
        *(_photos(project, review) if few else []),
    ]


def _status_words(project: Project, review: Review) -> dict[str, str]:
    """How far each image is, by file name."""
    with project.read() as connection:
        said = given_back(connection, [image.id for image in review.images])
    return {image.file_name: status_word(image.status, said.get(image.id)) for image in review.images}


def _table(images: Sequence[dict[str, Any]], status_words: Mapping[str, str]) -> Markup:
    head = ("Image", "Status", "CDR %", "Floor %", "px", "Matched", "Missed", "Extra")
    rows = [
        (
            row["file_name"],
            status_words[row["file_name"]],
            number(row["cdr"]["mean"]),
            number(row["floor"]["cdr_mean"]),
            number(row["px"]["mean"], 2),
            row["matched"],
            row["missed"],
            row["extra"],
        )
        for row in images
    ]
    return element("div", table(head, rows), id="images")


def _bars_of_images(review: Review, images: Sequence[dict[str, Any]], figures: dict[str, Any]) -> Markup:
    """The highest first."""
    bars = [
        Bar(name=row["file_name"], cdr=row["cdr"]["mean"], floor=row["floor"]["cdr_mean"])
        for row in images
        if row["cdr"]["mean"] is not None
    ]
    highest_first = sorted(bars, key=lambda bar: bar.cdr, reverse=True)
    others = element("a", "the table", href="#images")
    nothing = why_unmeasured(figures, second=review.second_annotator)
    return cdr_bars(highest_first, what="Mean CDR by image", others=others, nothing=nothing)


def _cap_by_cap(review: Review, images: Sequence[dict[str, Any]]) -> list[Markup]:
    """CDR of each cap of each image, as the paper's Figure 19."""
    plots = [element("h2", "CDR of each cap")] if images else []
    for place, row in enumerate(images):
        caps = sorted(
            (cap for cap in review.caps if cap.measured.page == place), key=lambda c: c.measured.truth or 0
        )
        bars = [
            Bar(name=cap.name, cdr=error.cdr, floor=cap.floor)
            for cap in caps
            if (error := cap.measured.error) is not None
        ]
        of = f"{row['file_name']}: "
        plots.append(
            cdr_bars(
                bars,
                what=f"{of}CDR of each cap",
                others=element("a", "caps.csv", href="#files"),
                nothing=of + _within_sentence(why_unmeasured(row, second=review.second_annotator), review),
            )
        )
    return plots


def _within_sentence(words: str, review: Review) -> str:
    """Without a capital in front, unless a name stands there."""
    is_name = words.startswith(review.second_annotator or "\0")
    return words if is_name else words[:1].lower() + words[1:]


def _photos(project: Project, review: Review) -> list[Markup]:
    """What was marked, what was predicted, and both."""
    second = review.second_annotator
    words = (
        "marked, with the numbers of the caps",
        second or "predicted",
        "both, with the lines between centres",
    )
    shown = []
    for image in review.images:
        pictures = zip(words, side_by_side(project, image.id, run=review.run), strict=False)
        of_one = (_photo(f"{image.file_name}: {word}", address) for word, address in pictures)
        shown.append(element("section", *of_one, class_="photos"))
    title = "Contours of both annotators" if second else "Marked and predicted contours"
    return [element("h2", title), *shown] if shown else []


def _photo(told: str, address: str) -> Markup:
    picture = element("img", src=address, alt=told)
    return element("figure", picture, element("figcaption", told), class_="photo")
