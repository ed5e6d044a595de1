"""The jobs: buttons that start them, their progress and results."""

from __future__ import annotations

import asyncio

from fairyring.app.jobs.comparing import compare_work
from fairyring.app.jobs.exports import export_work
from fairyring.app.jobs.runner import Job
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.job_progress import progress_of
from fairyring.app.panels.markup import Markup, element
from fairyring.storage.choices import Only
from fairyring.storage.exporting import Wanted

EVERY_S = 0.5
"""Seconds between two reports of a running job's progress."""
EXPORTS: dict[str, Only] = {
    "Approved images": Only.approved,
    "Annotated images": Only.annotated,
    "Annotations, else predictions": Only.all,
    "Predictions, latest of each image": Only.predicted,
}


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the buttons that start jobs, and the list of jobs."""
    gui = session.client.gui
    what = gui.add_dropdown("Export", tuple(EXPORTS), initial_value="Annotated images")
    export = gui.add_button("Export as COCO (zip)")
    compare = gui.add_button("Compare every image with its predictions")
    shown = gui.add_html("")

    async def start_export() -> None:
        title = f"Export: {what.value.lower()}"
        wanted = Wanted(only=EXPORTS[what.value])
        work = export_work(workspace.project, wanted, run=workspace.crew.patient.run)
        workspace.start_job(session, title, work)

    async def start_comparison() -> None:
        work = compare_work(workspace.project, run=workspace.crew.patient.run)
        workspace.start_job(session, "Comparison with the predictions", work)

    export.on_click(person_did(session, start_export))
    compare.on_click(person_did(session, start_comparison))

    ticking: set[asyncio.TimerHandle] = set()

    def tick() -> None:
        for timer in ticking:
            timer.cancel()
        ticking.clear()
        running = workspace.jobs.running
        for job in running:
            session.send(progress_of(job))
        if running:
            ticking.add(asyncio.get_running_loop().call_later(EVERY_S, tick))

    async def redraw() -> None:
        shown.content = job_list(list(workspace.jobs)).html
        tick()

    return redraw


def cancel(workspace: Workspace, session: Session, number: int) -> None:
    """Stops a job that the person at this tab has started, or nobody."""
    job = workspace.jobs.find(number)
    if job is not None and job.may_be_cancelled_by(session.user):
        job.cancel()


def job_list(jobs: list[Job]) -> Markup:
    """The list of jobs, newest first. How far those at work are stands in the header."""
    if not jobs:
        return element("div", "Nothing has run yet.", class_="fr-jobs fr-quiet")
    return element("ul", *(_row(job) for job in jobs), class_="fr-jobs")


def _row(job: Job) -> Markup:
    head = element(
        "div",
        element("strong", job.title, class_="fr-ellipsis", title=f"{job.title}, started by {job.user}"),
        element("span", job.state, class_=f"fr-badge fr-{job.state}"),
        class_="fr-line",
    )
    if job.state == "running":
        return element("li", head)
    link = element("a", "Download", href=job.link, download="") if job.link else None
    return element("li", head, element("div", job.message, " ", link, class_="fr-quiet"))
