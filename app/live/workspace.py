"""A served project: its store, sessions, jobs and background work."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.caps.comparison import Reviewer
from fairyring.app.jobs.runner import ITSELF, Job, Jobs, Result
from fairyring.app.live.read_ahead import RecentImages
from fairyring.app.live.session import Session, Tabs
from fairyring.app.settings import Settings
from fairyring.app.workers.crew import Crew, crew
from fairyring.model.errors import FairyringError
from fairyring.model.progress import Progress
from fairyring.storage.project import Project

Found = TypeVar("Found")
FIGURES = ("review", "gallery", "beside", "annotators", "plots", "cap_plot")
"""The parts of the panel that show what comparisons say."""


@dataclass(frozen=True, eq=False)
class Workspace:
    """One project, open in any number of tabs."""

    project: Project
    settings: Settings
    tabs: Tabs = field(default_factory=Tabs)
    jobs: Jobs = field(default_factory=Jobs)
    recent: RecentImages = field(default_factory=RecentImages)
    crew: Crew = field(default_factory=lambda: crew(apart=False))
    """Who computes; unless told otherwise threads of this process."""
    _ahead: set[asyncio.Task[None]] = field(default_factory=set)

    @cached_property
    def reviewer(self) -> Reviewer:
        """Compares images with their predictions after edits."""
        return Reviewer(
            self.project,
            compared=lambda _image: self.follow(*FIGURES, "images"),
            run=self.crew.patient.run,
        )

    def refresh(self, *parts: str) -> None:
        """Draws parts of every tab's panel anew."""
        for tab in self.tabs:
            tab.refresh(*parts)

    def follow(self, *parts: str) -> None:
        """Draws parts of every tab's panel anew soon."""
        for tab in self.tabs:
            tab.follow(*parts)

    def start_job(self, session: Session, title: str, work: Callable[[Progress], Result]) -> None:
        """Starts long work for the person at a tab, told when it has ended; the same work only once."""
        same = next((job for job in self.jobs.running if job.title == title), None)
        if same is not None:
            session.notify(f"{title}: at work already, started by {same.user}.")
            return

        def finished(job: Job) -> None:
            session.notify(f"{job.title}: {job.message}", "error" if job.state == "failed" else "info")
            self._show_end()

        self.jobs.start(title, work, user=session.user, finished=finished)
        self.refresh("status", "jobs")

    def start_own_job(self, title: str, work: Callable[[Progress], Result]) -> None:
        """Starts long work that nobody asked for, which anybody may stop."""
        self.jobs.start(title, work, user=ITSELF, finished=lambda _job: self._show_end())
        self.refresh("status", "jobs")

    def _show_end(self) -> None:
        self.refresh("status", "jobs", "predict", "runs", "learning", *FIGURES, "images")

    def read_ahead(self, image_ids: Sequence[int]) -> None:
        """Loads images that somebody is likely to open next, in the background."""

        async def load() -> None:
            for image_id in image_ids:
                with suppress(FairyringError):
                    await self.read(lambda connection, i=image_id: self.recent.load(connection, i))

        task = asyncio.create_task(load())
        self._ahead.add(task)
        task.add_done_callback(self._ahead.discard)

    async def close(self) -> None:
        """Stops all background work."""
        await self.jobs.close()
        await self.reviewer.close()
        await asyncio.gather(*self._ahead, return_exceptions=True)
        await anyio.to_thread.run_sync(self.crew.close)

    async def read(self, query: Callable[[Connection], Found]) -> Found:
        """Runs a query in a thread, so that the event loop never waits for the disk."""

        def in_thread() -> Found:
            with self.project.read() as connection:
                return query(connection)

        return await anyio.to_thread.run_sync(in_thread)

    async def write(self, work: Callable[[Connection], Found]) -> Found:
        """Runs a transaction; it is on disk when this returns."""
        return await anyio.to_thread.run_sync(self.project.write, work)
