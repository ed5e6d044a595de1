"""Tells a tab where annotations and predictions of its image differ."""

from __future__ import annotations

from functools import partial

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.caps.differences import differences_of
from fairyring.app.caps.repeated import Marks, marks_on
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Compared
from fairyring.storage.contents import load_annotations, load_predictions, load_turned_down
from fairyring.storage.images import get_image
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Annotation, Image, Prediction, Run
from fairyring.storage.runs import all_runs, get_run, predictions_by


async def compare_photo_with(workspace: Workspace, session: Session, run: Run | None) -> None:
    """Has photos compared with this run from now on (None: with the one on screen), this one at once."""
    session.run_on_photo = run
    session.refresh("review", "cap", "desk")
    if session.image is not None:
        await tell_differences(workspace, session, session.image.id)


async def compare_photo_with_number(workspace: Workspace, session: Session, number: int) -> None:
    """The same with the run of this number, as a cap of it is about to be shown.

    Raises StoreError where the project has no such run.
    """
    run, latest = await workspace.read(lambda c: (get_run(c, number), latest_run(c)))
    drawn = session.run_on_photo or latest
    if drawn is None or drawn.id != run.id:
        is_latest = latest is not None and run.id == latest.id
        await compare_photo_with(workspace, session, None if is_latest else run)
        session.redraw_at_once(("beside", "annotators"))


async def follow_run_on_photo(workspace: Workspace, session: Session) -> None:
    """Takes over what another process did to the run that photos are compared with: name, kind and end."""
    known = session.run_on_photo
    if known is None:
        return
    now = next((run for run in await workspace.read(all_runs) if run.id == known.id), None)
    if now == known:
        return
    await compare_photo_with(workspace, session, now)
    if now is None:
        told = f"The run {known.name} is gone: photos are compared with the latest of each image again."
        session.notify(told, "warning")


async def tell_differences(workspace: Workspace, session: Session, image_id: int) -> None:
    """Compares an image as it is stored now with the run on screen, or the one that the person chose.

    Raises StoreError where the project has no such image.
    """
    run = session.run_on_photo
    caps = await workspace.read(partial(_load, image_id=image_id, run=run))
    deleted = await workspace.read(partial(load_turned_down, image_id=image_id))
    worker = workspace.crew.of_image(image_id)
    found = await anyio.to_thread.run_sync(partial(worker.run, differences_of, *caps))
    extra = {cap.prediction.id for cap in found if cap.prediction and not cap.annotation}
    turned_down = [each for each in deleted if each.cap.prediction in extra]
    second = session.second_annotator
    session.send(Compared(image=image_id, caps=found, turned_down=turned_down, second=second))


def _load(
    connection: Connection, *, image_id: int, run: Run | None
) -> tuple[Image, list[Annotation], list[Prediction], Marks]:
    return (
        get_image(connection, image_id),
        load_annotations(connection, image_id),
        predictions_by(connection, run.id, image_id) if run else load_predictions(connection, image_id),
        marks_on(connection, image_id),
    )
