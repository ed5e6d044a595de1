"""Long work: progress, results, errors and cancelling; and the export as a person does it."""

from __future__ import annotations

import asyncio
import re
import threading
import time
from collections.abc import Callable
from io import BytesIO
from zipfile import ZipFile

import httpx
import msgspec

from fairyring.app.jobs.runner import KEPT, UNEXPECTED, Job, Jobs, Result
from fairyring.app.protocol import Notice, Show
from fairyring.model.errors import FairyringError
from fairyring.model.progress import Progress
from tests.support.tab import Tab, new_cap, until


def run(work: Callable[[Progress], Result], *, meanwhile: Callable[[Job], None] = lambda _: None) -> Job:
    """Runs one job to its end."""

    async def started() -> Job:
        ended = asyncio.Event()
        job = Jobs().start("Work", work, user="Ada", finished=lambda _: ended.set())
        await asyncio.sleep(0.05)
        meanwhile(job)
        await asyncio.wait_for(ended.wait(), 5)
        return job

    return asyncio.run(started())


def test_a_job_reports_progress_and_hands_back_its_result() -> None:
    seen: list[tuple[str, int, int]] = []
    gate = threading.Event()

    def work(progress: Progress) -> Result:
        progress(3, 7, "Counting")
        gate.wait(5)
        return Result("Seven counted.", link="/there")

    def look(job: Job) -> None:
        seen.append((job.what, job.done, job.total))
        gate.set()

    job = run(work, meanwhile=look)
    assert seen == [("Counting", 3, 7)]
    assert (job.state, job.message, job.link) == ("done", "Seven counted.", "/there")


def test_an_error_is_a_sentence_and_an_unexpected_one_gives_nothing_away() -> None:
    def known(_: Progress) -> Result:
        raise FairyringError("The folder is full; empty it.")

    def unknown(_: Progress) -> Result:
        raise RuntimeError("/secret/path")

    assert (run(known).state, run(known).message) == ("failed", "The folder is full; empty it.")
    assert (run(unknown).state, run(unknown).message) == ("failed", UNEXPECTED)


def test_a_cancelled_job_stops_at_its_next_step() -> None:
    steps = []

    def work(progress: Progress) -> Result:
        for step in range(1000):
            progress(step, 1000, "")
            steps.append(step)
            time.sleep(0.005)
        return Result("never")

    job = run(work, meanwhile=Job.cancel)
    assert job.state == "cancelled"
    assert 0 < len(steps) < 1000


def test_only_so_many_finished_jobs_stay_listed_and_none_that_runs_is_dropped() -> None:
    async def many() -> list[str]:
        jobs, gate = Jobs(at_once=2), threading.Event()

        def wait(_: Progress) -> Result:
            gate.wait(5)
            return Result("")

        jobs.start("long", wait, user="Ada", finished=lambda _: None)
        for _ in range(KEPT + 5):
            jobs.start("short", lambda _: Result(""), user="Ada", finished=lambda _: None)
            await asyncio.sleep(0.02)
        titles = [job.title for job in jobs]
        gate.set()
        await jobs.close()
        return titles

    titles = asyncio.run(many())
    assert titles.count("long") == 1
    assert titles.count("short") <= KEPT


def test_an_export_started_in_the_panel_can_be_downloaded_and_read(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.edit(new_cap(1))
        tab.panel.set("Export as COCO (zip)", True)
        assert "1 images, 1 annotations" in tab.expect(Notice).text
        link = until(lambda: re.search(r'href="(/downloads/[^"]+)"', tab.panel.html)).group(1)
    answer = httpx.get(f"http://127.0.0.1:{port}{link}", headers={"Cookie": "fairyring_name=Ada"})
    with ZipFile(BytesIO(answer.content)) as archive:
        document = msgspec.json.decode(archive.read("instances.json"))
        assert archive.testzip() is None
        assert [image["file_name"] for image in document["images"]] == ["bed_1.jpg"]
        assert len(document["annotations"]) == 1
        assert any(name.endswith("bed_1.jpg") for name in archive.namelist())
