"""Predicts a project's photos; each image is stored by itself, so that stopping loses nothing."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
import torch
from sqlalchemy import Connection

from fairyring.app.caps.filling_in import fill_in, one_by_one
from fairyring.app.caps.fitting import fitted_anew, likely_by_outline
from fairyring.app.jobs.finders import Finder, SeenCap
from fairyring.app.jobs.pace import note_pace
from fairyring.app.workers.crew import Run, here
from fairyring.model import photo
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.outline_checks import usable_outline
from fairyring.model.geometry.shapes import Fit
from fairyring.model.progress import Progress, silent
from fairyring.storage.images import get_image, keep_statistics
from fairyring.storage.predictions import (
    NewPrediction,
    RunAsked,
    add_predictions,
    continued_run,
    run_to_continue,
    seen_by,
)
from fairyring.storage.project import Project
from fairyring.storage.records import Image
from fairyring.storage.records import Run as StoredRun


@dataclass(kw_only=True)
class Outcome:
    """What became of the images that were to be predicted."""

    run: str
    """Name of the run that they went into."""
    images: int = 0
    """How many were predicted now."""
    caps: int = 0
    """How many caps were found in them."""
    known: int = 0
    """How many images this run had predicted before."""
    problems: list[str] = field(default_factory=list)
    """A sentence for each photo that could not be read."""

    def __str__(self) -> str:
        if not self.images and not self.problems:
            return f"Nothing to do: these weights have seen {counted(self.known, 'image')} before."
        parts = [f"{counted(self.images, 'image')} predicted, {counted(self.caps, 'cap')} seen"]
        if self.known:
            parts.append(f"{counted(self.known, 'image')} seen by these weights before")
        if self.problems:
            parts.append(f"{counted(len(self.problems), 'photo')} could not be read: {self.problems[0]}")
        return "; ".join(parts).removesuffix(".") + "."


def predict_images(
    project: Project,
    finder: Finder,
    image_ids: Sequence[int],
    *,
    redo: bool = False,
    called: str | None = None,
    compute: Run = here,
    progress: Progress = silent,
    predicted: Callable[[int], None] = lambda _: None,
) -> Outcome:
    """Predicts images, each stored whole in one transaction; ``predicted`` is called with its number then.

    The finder works in this process, the caps it saw are fitted by ``compute``.
    Images that show what this finder saw are passed over, unless ``redo``; so the same call again goes on
    where one was stopped. ``called`` is what the run is to be called. A photo that cannot be read is told of
    and passed over. Raises FairyringError where that is so of every one, or another run is called so, and
    whatever ``progress`` raises.
    """
    asked = RunAsked(
        name=finder.name, weights=finder.digest, settings=finder.settings, called=called, redo=redo
    )
    with project.read() as connection:
        going_on, seen = run_to_continue(connection, asked), seen_by(connection, asked)
        images = [get_image(connection, image_id) for image_id in image_ids if image_id not in seen]
    name = going_on.name if going_on else called or finder.name
    outcome = Outcome(run=name, known=len(image_ids) - len(images))
    run = _Run(asked)
    for done, image in enumerate(images):
        progress(done, len(images), f"Predicting {image.file_name}")
        began = time.monotonic()
        # What people labelled is fitted by what was measured on it, before the run's own takes its place.
        fill_in(project, [image.id], compute=one_by_one(compute))
        try:
            new, statistics = predictions_in(finder, project.originals.path_of(image), image, compute)
        except FairyringError as error:
            outcome.problems.append(str(error))
            continue
        outcome.run = project.write(
            partial(run.store, image_id=image.id, new=new, statistics=statistics)
        ).name
        note_pace(project, time.monotonic() - began)
        outcome.images += 1
        outcome.caps += len(new)
        predicted(image.id)
    if outcome.problems and not outcome.images:
        raise FairyringError(f"No photo could be read. {outcome.problems[0]}")
    return outcome


def leave_a_core() -> None:
    """Keeps torch from taking all cores: one is for the server that answers meanwhile."""
    torch.set_num_threads(max(1, (os.cpu_count() or 1) - 1))


class _Run:
    """The run that predictions go into; stored with the first of them."""

    def __init__(self, asked: RunAsked) -> None:
        self._asked = asked
        self._run: StoredRun | None = None

    def store(
        self,
        connection: Connection,
        *,
        image_id: int,
        new: Sequence[NewPrediction],
        statistics: Mapping[str, float],
    ) -> StoredRun:
        """Stores an image's predictions; to be called within ``Project.write``. Returns the run."""
        if self._run is None:
            self._run = continued_run(connection, self._asked)
        add_predictions(connection, run_id=self._run.id, image_id=image_id, predictions=new)
        keep_statistics(connection, image_id, statistics)
        return self._run


def predictions_in(
    finder: Finder, path: Path, image: Image, compute: Run = here
) -> tuple[list[NewPrediction], dict[str, float]]:
    """What is seen in the photo at ``path``, and the statistics by which its caps were fitted."""
    rgb = np.ascontiguousarray(photo.read(path)[:, :, ::-1])
    found = [
        replace(seen, outline=outline)
        for seen in finder.find(rgb)
        if (outline := usable_outline(seen.outline, width=image.width, height=image.height))
    ]
    likely = likely_by_outline((seen.outline, seen.whole) for seen in found)
    fits, statistics = compute(fitted_anew, image, [seen.outline for seen in found], likely)
    new = [_prediction(nth, seen, fit) for nth, (seen, fit) in enumerate(zip(found, fits, strict=True))]
    return new, statistics


def _prediction(nth: int, seen: SeenCap, fit: Fit) -> NewPrediction:
    spread = fit.centre_sd
    return NewPrediction(
        # By its place, so that the same photo seen twice by one run is stored once.
        uid=f"network-{nth}",
        visible=seen.outline,
        score=min(max(seen.score, 0.0), 1.0),
        quality=seen.quality,
        likely_whole=seen.whole,
        fit=fit,
        extra={"center_sd": [round(sd, 4) for sd in spread]} if spread else {},
    )


def counted(count: int, what: str) -> str:
    """``1 image``, ``2 images``."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
