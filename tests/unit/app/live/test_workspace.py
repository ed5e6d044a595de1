"""Long work as several people start it."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace
from typing import Any

from fairyring.app.jobs.runner import Result
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels import jobs
from fairyring.app.settings import Settings
from fairyring.model.progress import Progress
from fairyring.storage.project import Project


def somebody(name: str) -> Any:
    told: list[str] = []
    return SimpleNamespace(user=name, told=told, notify=lambda text, _level="info": told.append(text))


def test_the_same_work_is_queued_once_and_others_are_told_who_started_it(project: Project) -> None:
    workspace, ada, bob, gate = (
        Workspace(project, Settings()),
        somebody("Ada"),
        somebody("Bob"),
        threading.Event(),
    )

    def wait(_: Progress) -> Result:
        gate.wait(5)
        return Result("Packed.")

    async def clicks() -> list[str]:
        workspace.start_job(ada, "Export", wait)
        workspace.start_job(ada, "Export", wait)
        workspace.start_job(bob, "Export", wait)
        workspace.start_job(bob, "Comparison", wait)
        titles = [job.title for job in workspace.jobs.running]
        gate.set()
        await workspace.close()
        return titles

    assert asyncio.run(clicks()) == ["Comparison", "Export"]
    assert bob.told[0] == "Export: at work already, started by Ada."
    assert ada.told == ["Export: at work already, started by Ada.", "Export: Packed."]


def test_cancel_is_for_what_one_has_started_oneself(project: Project) -> None:
    workspace, ada, bob, gate = (
        Workspace(project, Settings()),
        somebody("Ada"),
        somebody("Bob"),
        threading.Event(),
    )

    def work(progress: Progress) -> Result:
        gate.wait(5)
        progress(1, 2, "Working")
        return Result("Done.")

    async def cancel() -> dict[str, str]:
        workspace.start_job(ada, "Export", work)
        workspace.start_job(bob, "Comparison", work)
        for job in workspace.jobs:
            jobs.cancel(workspace, bob, job.id)
        gate.set()
        while workspace.jobs.running:
            await asyncio.sleep(0.01)
        return {job.user: job.state for job in workspace.jobs}

    assert asyncio.run(cancel()) == {"Ada": "done", "Bob": "cancelled"}
