"""Comparisons started in the app: every image of the latest run against its predictions."""

from __future__ import annotations

from collections.abc import Callable

from fairyring.app.caps.comparison import compare_image
from fairyring.app.how_many import how_many
from fairyring.app.jobs.runner import Result
from fairyring.app.workers.crew import Run, here
from fairyring.model.progress import Progress
from fairyring.storage.compared_runs import lacking_comparison
from fairyring.storage.comparisons import stale_images
from fairyring.storage.predictions import latest_run
from fairyring.storage.project import Project
from fairyring.storage.records import Run as Predicting


def compare_work(project: Project, *, run: Run = here) -> Callable[[Progress], Result]:
    """The work of a job that brings the figures of every image of the latest run up to date."""

    def work(progress: Progress) -> Result:
        with project.read() as connection:
            latest = latest_run(connection)
            stale = stale_images(connection, latest.id) if latest else []
        for done, image_id in enumerate(stale):
            progress(done, len(stale), "Comparing caps with predictions")
            compare_image(project, image_id, run=run)
        return Result(
            f"{how_many(len(stale), 'image')} compared." if stale else "Every image was up to date."
        )

    return work


def compare_with_run_work(project: Project, run: Predicting) -> Callable[[Progress], Result]:
    """The work of a job that brings the figures of all images that an earlier run saw up to date."""

    def work(progress: Progress) -> Result:
        with project.read() as connection:
            lacking = lacking_comparison(connection, run.id)
        for done, image_id in enumerate(lacking):
            progress(done, len(lacking), f"Comparing caps with {run.name}")
            compare_image(project, image_id, with_run=run.id)
        return Result(f"{how_many(len(lacking), 'image')} compared with {run.name}.")

    return work
