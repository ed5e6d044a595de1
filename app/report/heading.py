"""What a report is of: which images, and whose predictions."""

from __future__ import annotations

from fairyring.app.panels.markup import Markup, element
from fairyring.app.review.figures import Review
from fairyring.storage.project import Project
from fairyring.storage.runs import latest_runs_of

MOST_RUNS = 4
"""So many runs are named."""


def title_of(project: Project, review: Review) -> str:
    """Names the project, or the image where the report is of one, or says how many of them it is of."""
    names = [*(image.file_name for image in review.images), *review.untouched]
    if not review.of_some:
        return f"Review of {project.name}"
    return f"Review of {names[0]}" if len(names) == 1 else f"Review of {len(names)} images of {project.name}"


def heading(project: Project, review: Review) -> Markup:
    """The title, and whose predictions are held against what people marked."""
    of = f"An image of {project.name}. " if is_of_one(review) else ""
    return element(
        "header",
        element("h1", title_of(project, review)),
        element("p", of + _predictions(project, review), class_="quiet"),
    )


def is_of_one(review: Review) -> bool:
    """Whether one image was asked for, and not all that there are."""
    return review.of_some and len(review.images) + len(review.untouched) == 1


def _predictions(project: Project, review: Review) -> str:
    if review.second_annotator is not None:
        return f"Held against {review.second_annotator}, which a second annotator labelled."
    if review.run is not None:
        return f"Held against the predictions of {review.run.name}."
    with project.read() as connection:
        runs = [run.name for run, _ in latest_runs_of(connection, (image.id for image in review.images))]
    if not runs:
        return "There are no predictions of it."
    more = f" and {len(runs) - MOST_RUNS} earlier runs" if len(runs) > MOST_RUNS else ""
    whose = f"the latest predictions of each image, by {', '.join(runs[-MOST_RUNS:])}{more}"
    return f"Held against {runs[0] if len(runs) == 1 else whose}."
