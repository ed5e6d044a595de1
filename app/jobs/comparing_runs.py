"""The job that holds two runs against what people labelled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fairyring.app.caps.runs_compared import compare_runs
from fairyring.app.how_many import how_many
from fairyring.app.jobs.runner import Result
from fairyring.model.evaluate.centre_figures import CapPairing
from fairyring.model.evaluate.two_runs import difference_of
from fairyring.model.progress import Progress
from fairyring.storage.project import Project
from fairyring.storage.records import Run


def compare_runs_work(project: Project, first: Run, second: Run) -> Callable[[Progress], Result]:
    """The work of a job whose message says which run is nearer, and which finds more."""

    def work(progress: Progress) -> Result:
        compared = compare_runs(project, first, second, CapPairing(), progress=progress)
        said = [
            f"{run.name}: {_figures(of.figures)}"
            for run, of in ((first, compared.first), (second, compared.second))
        ]
        difference = difference_of(compared.first, compared.second)
        images = how_many(compared.images, "image")
        return Result(f"On {images}. {' '.join(said)} {_nearer(difference, first, second)}")

    return work


def _figures(figures: dict[str, Any]) -> str:
    cdr, px = figures["cdr"]["mean"], figures["px"]["mean"]
    means = "" if cdr is None else f"mean CDR {cdr:.3f} %, {px:.2f} px; "
    return f"{means}{figures['matched']} found, {figures['missed']} missed, {figures['extra']} extra."


def _nearer(difference: dict[str, Any], first: Run, second: Run) -> str:
    if not difference["both"]:
        return "No cap was found by both."
    interval = difference["px"]
    apart = (
        f"second less first {interval['mean']:+.2f} px ({interval['low']:+.2f} to {interval['high']:+.2f})"
    )
    return (
        f"Of the {how_many(difference['both'], 'cap')} that both found, {first.name} is nearer in "
        f"{difference['first_nearer']}, {second.name} in {difference['second_nearer']}: {apart}."
    )
