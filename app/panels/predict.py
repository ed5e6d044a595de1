"""Predicting from the panel: the weights, and buttons for one image and for all."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypedDict

import anyio.to_thread

from fairyring.app.jobs.pace import seconds_an_image
from fairyring.app.jobs.runner import Result
from fairyring.app.live.opening import show_predictions
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.job_progress import about
from fairyring.app.panels.markup import Markup, element
from fairyring.app.weights import digest_in, require_weights, weights_of
from fairyring.app.workers.crew import Run
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.progress import Progress
from fairyring.storage.folder import WEIGHTS
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.predictions import count_unseen
from fairyring.storage.project import Project

EVERY = "Predict every image"
WIDTH_HINT = "How wide most caps are in the photos. 0: measured in each photo."


NAME_HINT = "Else it is called after its weights, or goes on with the run before."


class Said(TypedDict):
    """What a person says of a prediction."""

    diameter: float | None
    called: str | None


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the line that names the weights, and the two buttons."""
    gui = session.client.gui
    shown = gui.add_html("")
    width = gui.add_number("Cap width, px", 0, min=0, max=5000, step=1, hint=WIDTH_HINT)
    name = gui.add_text("Name of the run", "", hint=NAME_HINT)
    one = gui.add_button("Predict this image")
    every = gui.add_button(EVERY)

    def said() -> Said:
        return {"diameter": float(width.value) or None, "called": name.value.strip() or None}

    async def predict_shown() -> None:
        if session.image is not None:
            title = f"Prediction of {session.image.file_name}"
            start(workspace, session, title, [session.image.id], **said())

    async def predict_every() -> None:
        ids = await workspace.read(lambda connection: list_ids(connection, ImageFilter()))
        start(workspace, session, "Prediction of every image", ids, **said())

    one.on_click(person_did(session, predict_shown))
    every.on_click(person_did(session, predict_every))

    async def redraw() -> None:
        found = await anyio.to_thread.run_sync(weights_of, workspace.project)
        shown.content = weights_line(found, workspace.project).html
        one.disabled = every.disabled = found is None
        every.label = await _words_for_every(workspace, found) if found else EVERY

    return redraw


async def _words_for_every(workspace: Workspace, weights: Path) -> str:
    digest = await anyio.to_thread.run_sync(digest_in, weights)
    count = await workspace.read(lambda connection: count_unseen(connection, weights=digest))
    pace = await anyio.to_thread.run_sync(seconds_an_image, workspace.project)
    return words_for_every(count, pace)


def words_for_every(count: int, seconds: float | None) -> str:
    """What the button for every image says: how many these weights have not seen, and how long they take.

    Args:
        count: of images.
        seconds: an image takes; None where nothing was predicted yet.
    """
    if not count:
        return f"{EVERY} (none is left)"
    images = f"{count} image{'' if count == 1 else 's'}"
    return f"{EVERY}: {images}" + (
        ", time not known yet" if seconds is None else f", {about(count * seconds)}"
    )


async def predict_one(workspace: Workspace, session: Session, image_id: int) -> None:
    """Has the network look at an image, as the button on an empty one asks. Raises StoreError without it."""
    image = await workspace.read(lambda connection: get_image(connection, image_id))
    start(workspace, session, f"Prediction of {image.file_name}", [image.id])


def start(
    workspace: Workspace,
    session: Session,
    title: str,
    image_ids: Sequence[int],
    *,
    diameter: float | None = None,
    called: str | None = None,
) -> None:
    """Starts the job that predicts images, each drawn as soon as it is stored."""
    loop = asyncio.get_running_loop()

    def predicted(image_id: int) -> None:
        # Waits, so that nobody is told of the end before the last image is drawn.
        asyncio.run_coroutine_threadsafe(show_predictions(workspace, image_id), loop).result()

    work = predict_work(
        workspace.project,
        image_ids,
        diameter=diameter,
        called=called,
        compute=workspace.crew.patient.run,
        predicted=predicted,
    )
    workspace.start_job(session, title, work)


def weights_line(found: Path | None, project: Project) -> Markup:
    """Says which weights the buttons take."""
    if found is None:
        folder = element("code", str(project.folder / WEIGHTS))
        words = ("No weights to predict with: put a file that fairyring train made into ", folder, ".")
    elif found == SHIPPED:
        words = ("Weights: ", element("strong", found.name), ", which came with Fairyring.")
    else:
        words = ("Weights: ", element("strong", found.name), ", the newest in the project's weights folder.")
    return element("div", *words, class_="fr-jobs fr-quiet")


def predict_work(
    project: Project,
    image_ids: Sequence[int],
    *,
    diameter: float | None = None,
    called: str | None = None,
    compute: Run,
    predicted: Callable[[int], None],
) -> Callable[[Progress], Result]:
    """The work of a job that predicts images, whose caps ``compute`` has fitted.

    ``predicted`` is called in the job's thread once an image is stored.
    """

    def work(progress: Progress) -> Result:
        progress(0, len(image_ids), "Loading the network")
        # Torch takes seconds to load, and a project can be served without it.
        from fairyring.app.jobs.finders import network_of
        from fairyring.app.jobs.predicting import leave_a_core, predict_images

        leave_a_core()
        network = network_of(require_weights(project), diameter=diameter)
        outcome = predict_images(
            project,
            network,
            image_ids,
            called=called,
            compute=compute,
            progress=progress,
            predicted=predicted,
        )
        return Result(f"{outcome.run}: {outcome}")

    return work
