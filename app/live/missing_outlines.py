"""Whole outlines that an import left to be found: of an image before it is opened, of all others by a job."""

from __future__ import annotations

import logging
from functools import partial

import anyio.to_thread

from fairyring.app.caps.filling_in import WHAT, fill_in, one_by_one
from fairyring.app.jobs.runner import Result
from fairyring.app.live.workspace import Workspace
from fairyring.app.workers.worker import WorkerError
from fairyring.model.progress import Progress
from fairyring.storage.derived import images_with_underived

log = logging.getLogger(__name__)


async def find_outlines_of(workspace: Workspace, image_id: int) -> None:
    """Sees to it that an image has its whole outlines before they are looked at."""
    compute = one_by_one(workspace.crew.of_image(image_id).run)
    try:
        await anyio.to_thread.run_sync(partial(fill_in, workspace.project, [image_id], compute=compute))
    except WorkerError as error:
        log.warning("Whole outlines of image %d are still missing: %s", image_id, error)


async def find_other_outlines(workspace: Workspace) -> None:
    """Starts a job that finds all that are missing, unless there are none or one is at work."""
    lacking = await workspace.read(images_with_underived)
    if lacking and not any(job.title == WHAT for job in workspace.jobs.running):
        workspace.start_own_job(WHAT, partial(_work, workspace))


def _work(workspace: Workspace, progress: Progress) -> Result:
    compute = one_by_one(workspace.crew.patient.run)
    found = fill_in(workspace.project, compute=compute, progress=progress)
    return Result(f"Found those of {found} caps.")
