"""Tables 2, 3 and 4 of the paper, from the project's own images and runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.report.tables import number, percent, table
from fairyring.app.review.figures import Review
from fairyring.app.review.reviewed import reviewed_images
from fairyring.model.evaluate.masks import MaskScores, score_masks
from fairyring.model.evaluate.pages import Page
from fairyring.storage.project import Project
from fairyring.storage.records import Run
from fairyring.storage.runs import all_runs, images_seen_by

MOST_RUNS = 4
"""How many of the latest runs stand in Tables 2 and 3."""
UNTOLD = "not known"


@dataclass(frozen=True, eq=False, kw_only=True)
class _Scored:
    """A run on those images of a review that it saw."""

    run: Run
    images: int
    scores: MaskScores
    by_light: dict[str, MaskScores]


def paper_tables(project: Project, review: Review) -> Markup:
    """The three tables. A run is measured on those of the review's images that it saw."""
    scored = _scored(project, review)
    return element("section", *_table_2(scored), *_table_3(scored), *_table_4(review))


def _scored(project: Project, review: Review) -> list[_Scored]:
    numbers = [image.id for image in review.images]
    found = []
    with project.read() as connection:
        runs = all_runs(connection)
        for run in reversed([run for run in runs if run.kind != "second"]):
            seen = {image.id for image in images_seen_by(connection, run.id)}
            wanted = [number for number in numbers if number in seen]
            pages = [each.page for each in reviewed_images(connection, wanted, run=run)]
            if pages and len(found) < MOST_RUNS:
                by_light = {light: score_masks(some) for light, some in _by_light(pages).items()}
                found.append(
                    _Scored(run=run, images=len(pages), scores=score_masks(pages), by_light=by_light)
                )
    return found


def _by_light(pages: Sequence[Page]) -> dict[str, list[Page]]:
    groups: dict[str, list[Page]] = {}
    for page in pages:
        groups.setdefault(page.light or UNTOLD, []).append(page)
    return dict(sorted(groups.items()))


def _table_2(scored: Sequence[_Scored]) -> list[Markup]:
    told = "Precision and recall at IoU .5 of predictions from a score of .5 on; the paper calls AR its R."
    rows = [
        (
            each.run.name,
            each.images,
            number(each.scores.p),
            number(each.scores.r),
            percent(each.scores.ar),
            percent(each.scores.ap),
            percent(each.scores.ap50),
            percent(each.scores.ap75),
        )
        for each in scored
    ]
    head = ("Run", "Images", "P", "R", "AR %", "AP %", "AP50 %", "AP75 %")
    return _titled("Effect of segmentation (Table 2)", told, head, rows)


def _table_3(scored: Sequence[_Scored]) -> list[Markup]:
    told = (
        "Caps from 30 px on that were found one to one at IoU .5; under 30 px they count apart, "
        "as the paper misses them by design."
    )
    rows = [
        (light, each.run.name, count, round((scores.s50 or 0.0) * count), percent(scores.s50))
        for each in scored
        for light, scores in each.by_light.items()
        if (count := scores.counts.truths - scores.counts.small) >= 0
    ]
    head = ("Light", "Run", "Caps", "Found", "Success rate %")
    *words, figures = _titled("Segmentation success rate (Table 3)", told, head, rows)
    return [*words, element("div", figures, class_="two-names")]


def _table_4(review: Review) -> list[Markup]:
    second = review.second_annotator
    whose = f"that {second} has, too" if second else "with a prediction"
    told = f"Marked caps {whose}, and what their marks are off by themselves."
    rows: list[tuple[Content, ...]] = []
    for place, image in enumerate(review.images):
        measured = [cap for cap in review.caps if cap.measured.page == place and cap.measured.error]
        errors = [cap.measured.error.cdr for cap in measured if cap.measured.error]
        floors = [cap.floor for cap in measured if cap.floor is not None]
        if errors:
            rows.append((image.file_name, len(errors), number(_mean(errors), 2), number(_mean(floors), 2)))
    every = [cap.measured.error.cdr for cap in review.caps if cap.measured.error]
    floors = [cap.floor for cap in review.caps if cap.measured.error and cap.floor is not None]
    rows.append(("average", len(every), number(_mean(every), 2), number(_mean(floors), 2)))
    head = ("Image", "Contours", "Average CDR %", "Floor %")
    return _titled("Average CDR (Table 4)", told, head, rows)


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None


def _titled(title: str, told: str, head: Sequence[str], rows: Sequence[Sequence[Content]]) -> list[Markup]:
    return [element("h2", title), element("p", told, class_="quiet"), table(head, rows)]
