"""The figures of a review: CDR beside what a person's hand is off by, of all caps, of groups and of images.

A figure without its floor would make a network look wrong by what is the annotator's own noise.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Container, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from msgspec import structs, to_builtins

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.caps.records import is_unsure
from fairyring.app.caps.repeated import floor_figures, repeated_marks
from fairyring.app.review.groups import NOT_KNOWN, TITLES, in_order
from fairyring.app.review.reviewed import ReviewedImage, reviewed_images, worked_on
from fairyring.app.review.said import Said, entry_of, said_of
from fairyring.model.evaluate.cap_rows import Measured, measured_caps, visibility_of
from fairyring.model.evaluate.centre_figures import figures_of_caps
from fairyring.model.evaluate.centres import compare, summarise
from fairyring.model.evaluate.pages import Page
from fairyring.model.evaluate.repeated_marks import RepeatedMark
from fairyring.model.progress import Progress, silent
from fairyring.storage.project import Project
from fairyring.storage.records import Image, Run
from fairyring.storage.runs import images_seen_by

MOST_WORST = 24
"""How many of the worst caps are listed."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ReviewedCap:
    """A cap or an extra prediction, measured, with what the review adds."""

    measured: Measured
    image: int
    annotator: str | None = None
    """Who edited it last; of an extra prediction who edited most caps of its image."""
    shape: str | None = None
    """Regular where it is marked by a circle, else irregular; None where nothing is marked."""
    floor: float | None = None
    """CDR that its mark has by itself, percent; None where that is not known, or nothing is marked."""
    is_unsure: bool = False
    is_doubtful: bool = False

    @property
    def key(self) -> tuple[int, int | None]:
        """Which cap it is among those of a review: the place of its image, and its own there."""
        return self.measured.page, self.measured.truth

    @property
    def name(self) -> str:
        """What it is called on its image: caps are numbered in the order in which they were made."""
        return "extra" if self.measured.truth is None else f"cap {self.measured.truth + 1}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Review:
    """What a reviewer looks at."""

    run: Run | None
    """Whose predictions; None for the latest of each image."""
    images: list[Image]
    """Those somebody worked on, by name."""
    pages: list[Page]
    """The same, without their caps."""
    caps: list[ReviewedCap]
    untouched: list[str]
    """File names of the images that nobody has worked on."""
    of_some: bool
    """Whether only some images were asked for."""
    said: list[Said]
    """What reviewers said of all these images and their caps, image by image, the first one first."""
    left_out: int
    """How many caps were left out as doubtful or unsure."""
    repeats: list[RepeatedMark]
    """Caps that somebody marked twice."""

    @property
    def second_annotator(self) -> str | None:
        """Whose version stands for predictions, where that is a second annotator's."""
        return self.run.second_annotator if self.run else None


def review_of(
    project: Project,
    *,
    run: Run | None = None,
    images: str = "*",
    among: Container[int] | None = None,
    only_sure: bool = False,
    progress: Progress = silent,
) -> Review:
    """Compares every image that somebody worked on with the latest predictions of it, or those of a run.

    Of a second annotator's version only the images that it is of are compared.

    Args:
        project: whose images.
        run: whose predictions; None for the latest of each image.
        images: only images of these file names, which may hold ``*`` and ``?``.
        among: only images of these numbers; None for all.
        only_sure: leaves out caps that are doubtful, and those whose mark hardly determines a centre.
        progress: called once an image; what it raises ends the review.

    Raises:
        StoreError: the database cannot be read.
    """
    found_images: list[Image] = []
    pages: list[Page] = []
    caps: list[ReviewedCap] = []
    left_out = 0
    fill_in(project, progress=progress)
    with project.read() as connection:
        wanted = among
        if run is not None and run.second_annotator:
            seen_by = {image.id for image in images_seen_by(connection, run.id)}
            wanted = seen_by if among is None else {number for number in seen_by if number in among}
        touched, untouched = worked_on(connection, images=images, among=wanted)
        numbers = [image.id for image in touched]
        said = said_of(connection, [*touched, *untouched])
        repeats = repeated_marks(connection)
        for done, seen in enumerate(reviewed_images(connection, numbers, run=run)):
            progress(done, len(numbers), "Comparing caps with predictions")
            found = _caps_of(seen, place=len(pages))
            kept = [cap for cap in found if not (only_sure and (cap.is_unsure or cap.is_doubtful))]
            left_out += len(found) - len(kept)
            found_images.append(seen.image)
            pages.append(structs.replace(seen.page, truths=[], predictions=[]))
            caps += kept
    return Review(
        run=run,
        images=found_images,
        pages=pages,
        caps=caps,
        untouched=[image.file_name for image in untouched],
        of_some=images != "*" or among is not None,
        said=said,
        left_out=left_out,
        repeats=repeats,
    )


def figures_of(review: Review) -> dict[str, Any]:
    """What ``fairyring review --json`` prints: figures of all caps, of groups, images and annotators."""
    of_image = defaultdict(list)
    for cap in review.caps:
        of_image[cap.measured.page].append(cap)
    return _figures(review.caps) | {
        "images": [_image_figures(image, of_image[place]) for place, image in enumerate(review.images)],
        "groups": _groups(review),
        "worst": [_row(cap) for cap in worst_caps(review.caps)],
        "verdicts": [entry_of(each) for each in review.said],
        "untouched": review.untouched,
        "left_out": review.left_out,
        "marked_again": floor_figures(review.repeats),
    }


def _groups(review: Review) -> dict[str, dict[str, Any]]:
    """Figures by kind and value. Where no value of a kind is known there are no groups of it."""
    caps: dict[str, dict[str, list[ReviewedCap]]] = {kind: defaultdict(list) for kind in TITLES}
    for cap in review.caps:
        page, row = review.pages[cap.measured.page], cap.measured.row
        of_cap = {
            "size": row.size,
            "visibility": visibility_of(row),
            "shape": cap.shape,
            "light": page.light,
            "form": page.form,
            "annotator": cap.annotator,
        }
        for kind, value in of_cap.items():
            caps[kind][value or NOT_KNOWN].append(cap)
    figures = {
        kind: {value: _figures(some) for value, some in values.items()} if {*values} - {NOT_KNOWN} else {}
        for kind, values in caps.items()
    }
    return {kind: in_order(kind, values, cdr=_mean_cdr) for kind, values in figures.items()}


def worst_caps(caps: Sequence[ReviewedCap], *, most: int = MOST_WORST) -> list[ReviewedCap]:
    """The measured caps of all images whose CDR exceeds their floor by most, the worst first."""
    measured = [cap for cap in caps if cap.measured.error]
    return sorted(measured, key=_excess, reverse=True)[:most]


def _excess(cap: ReviewedCap) -> float:
    assert cap.measured.error is not None, "measured caps alone are sorted"
    return cap.measured.error.cdr - (cap.floor or 0.0)


def _caps_of(seen: ReviewedImage, *, place: int) -> list[ReviewedCap]:
    page = seen.page
    found = compare(page.truths, page.predictions, width=page.width, height=page.height)
    return [_reviewed(seen, measured) for measured in measured_caps(place, page, found)]


def _reviewed(seen: ReviewedImage, measured: Measured) -> ReviewedCap:
    if measured.truth is None:
        return ReviewedCap(measured=measured, image=seen.image.id, annotator=seen.marks.annotator)
    annotation, image = seen.annotations[measured.truth], seen.image
    record = seen.page.truths[measured.truth]
    of = seen.marks.class_of(annotation, record)
    return ReviewedCap(
        measured=measured,
        image=image.id,
        annotator=of.annotator,
        shape=of.shape,
        floor=seen.marks.floor_of(annotation, record, image),
        is_unsure=is_unsure(annotation),
        is_doubtful=annotation.cap.doubtful,
    )


def _figures(caps: Sequence[ReviewedCap]) -> dict[str, Any]:
    """Those of ``evaluate centres``, the floor of the marks, and how many caps are of each kind."""
    return figures_of_caps([cap.measured for cap in caps if cap.measured.truth is not None]) | _counts(caps)


def _counts(caps: Sequence[ReviewedCap]) -> dict[str, Any]:
    floors = [cap.floor for cap in caps if cap.floor is not None and cap.measured.error]
    outcomes = Counter(cap.measured.row.outcome for cap in caps)
    return {
        **{outcome: outcomes[outcome] for outcome in ("matched", "missed", "extra")},
        "marked": sum(cap.measured.row.mark is not None for cap in caps),
        "doubtful": sum(cap.is_doubtful for cap in caps),
        "unsure_marks": sum(cap.is_unsure for cap in caps),
        "floor": {"cdr_mean": float(np.mean(floors)) if floors else None, "count": len(floors)},
    }


def _mean_cdr(figures: dict[str, Any]) -> float | None:
    return figures["cdr"]["mean"]


def _image_figures(image: Image, caps: Sequence[ReviewedCap]) -> dict[str, Any]:
    errors = [cap.measured.error for cap in caps if cap.measured.error]
    own = {"file_name": image.file_name, "status": image.status, "light": image.light, "form": image.form}
    return own | to_builtins(summarise(errors)) | _counts(caps)


def _row(cap: ReviewedCap) -> dict[str, Any]:
    row = structs.asdict(cap.measured.row)
    return row | {"floor": cap.floor, "annotator": cap.annotator, "unsure_mark": cap.is_unsure}
