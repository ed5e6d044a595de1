"""Two runs of a project against what people labelled there, on the images that both of them saw."""

from __future__ import annotations

from msgspec import Struct

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.caps.records import prediction_record, truth_record
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.centre_figures import CapPairing, Evaluated, evaluated_pages
from fairyring.model.evaluate.pages import Page
from fairyring.model.progress import Progress, silent
from fairyring.storage.contents import load_annotations
from fairyring.storage.project import Project
from fairyring.storage.records import Run
from fairyring.storage.runs import images_seen_by, predictions_by


class ComparedRuns(Struct, frozen=True, kw_only=True):
    """Two runs on the same images."""

    first: Evaluated
    second: Evaluated
    images: int


def compare_runs(
    project: Project, first: Run, second: Run, pairing: CapPairing, *, progress: Progress = silent
) -> ComparedRuns:
    """Holds both runs against the annotations of the images that both saw and people labelled.

    Raises FairyringError where there is no such image.
    """
    fill_in(project, progress=progress)
    pages: tuple[list[Page], list[Page]] = ([], [])
    with project.read() as connection:
        seen = {image.id for image in images_seen_by(connection, second.id)}
        common = [image for image in images_seen_by(connection, first.id) if image.id in seen]
        for done, image in enumerate(common):
            progress(done, len(common), "Reading caps")
            truths = [truth_record(cap, image) for cap in load_annotations(connection, image.id)]
            if not truths:
                continue
            for run, of_run in zip((first, second), pages, strict=True):
                guesses = [
                    prediction_record(cap, image) for cap in predictions_by(connection, run.id, image.id)
                ]
                of_run.append(
                    Page(
                        file_name=image.file_name,
                        width=image.width,
                        height=image.height,
                        truths=truths,
                        predictions=guesses,
                        light=image.light,
                        form=image.form,
                    )
                )
    if not pages[0]:
        raise FairyringError(
            f"There is no image with annotations that both {first.name} and {second.name} saw."
        )
    return ComparedRuns(
        first=evaluated_pages(pages[0], pairing),
        second=evaluated_pages(pages[1], pairing),
        images=len(pages[0]),
    )
