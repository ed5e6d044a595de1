"""Trains the weights that a project is predicted with further, on what people corrected in it."""

from __future__ import annotations

import shutil
from pathlib import Path

import msgspec

from fairyring.app.jobs.division import divided
from fairyring.app.jobs.learnt import FIGURES, REPORT, Learnt, new_folder
from fairyring.app.jobs.predicting import leave_a_core
from fairyring.app.jobs.training import Asked, further, train_as_asked
from fairyring.app.jobs.training_labels import labels_at
from fairyring.app.weights import require_weights
from fairyring.model.device import device_of
from fairyring.model.errors import FairyringError
from fairyring.model.network.weights import load_weights
from fairyring.model.progress import Progress
from fairyring.model.train.validate import validate
from fairyring.storage.project import Project


def learn(project: Project, *, steps: int, progress: Progress) -> Learnt:
    """Trains for so many steps; what is held out is seen by the weights before and after.

    Raises FairyringError where nothing can be learnt, and whatever ``progress`` raises.
    """
    leave_a_core()
    base = require_weights(project)
    out = new_folder(project)
    asked = Asked(weights=str(base), iterations=steps, lenient=True)
    try:
        before = _figures_before(project, base, progress)
        # Processes of its own would be copies of the server, so this one makes the batches as well.
        trained = train_as_asked(
            [project.folder], out, asked, device="auto", workers=0, progress=progress, say=lambda _: None
        )
    except FairyringError:
        shutil.rmtree(out, ignore_errors=True)
        raise
    learnt = Learnt(
        name=out.name,
        base=base.stem,
        weights=str(trained.weights),
        photos=str(trained.photos),
        held_out=trained.photos.figures()["validated"],
        before=before,
        after=_compared(trained.figures),
    )
    (out / REPORT).write_bytes(msgspec.json.encode(learnt))
    return learnt


def _figures_before(project: Project, base: Path, progress: Progress) -> dict[str, float]:
    """Figures of the weights that are trained further, on the photos that the training will hold out."""
    labels = labels_at([project.folder], lenient=True, progress=progress)
    recipe = further(labels.examples)
    held_out = divided(labels, None, seed=recipe.seed).checked[: recipe.validate_images]
    if not held_out:
        return {}
    network = load_weights(base).network
    return _compared(validate(network, held_out, device=device_of("auto"), progress=progress).figures)


def _compared(figures: dict[str, object]) -> dict[str, float]:
    return {name: value for name in FIGURES if isinstance(value := figures.get(name), float)}
