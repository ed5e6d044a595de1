"""What a served project consists of, handed to everything that needs it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

import anyio.to_thread
from sqlalchemy import Connection

from app.jobs import Jobs
from app.session import Tabs
from app.settings import Settings
from storage.project import Project

Found = TypeVar("Found")


@dataclass(frozen=True)
class Workspace:
    """One project, open in any number of tabs."""

    project: Project
    settings: Settings
    tabs: Tabs = field(default_factory=Tabs)
    jobs: Jobs = field(default_factory=Jobs)

    async def read(self, query: Callable[[Connection], Found]) -> Found:
        """Runs a query in a thread, so that the event loop never waits for the disk."""

        def run() -> Found:
            with self.project.read() as connection:
                return query(connection)

        return await anyio.to_thread.run_sync(run)

    async def write(self, work: Callable[[Connection], Found]) -> Found:
        """Runs a transaction; it is on disk when this returns."""
        return await anyio.to_thread.run_sync(self.project.write, work)
