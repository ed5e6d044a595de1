"""How far a job is: a line with its bar, the time left and a button that stops it.

The line is drawn once; what changes twice a second goes to the editor, which writes it into the line, so that
a button under the pointer or with the focus is not replaced.
"""

from __future__ import annotations

from fairyring.app.jobs.runner import Job
from fairyring.app.panels.markup import Markup, element
from fairyring.app.protocol import JobProgress


def progress_line(job: Job, *, own: bool) -> Markup:
    """The line of a job at work; one's ``own`` can be cancelled, and what nobody asked for."""
    cancel = element("button", "Cancel", type="button", data_fairyring_cancel=job.id) if own else None
    return element(
        "div",
        element("span", job.title, class_="fr-ellipsis", title=f"{job.title}, started by {job.user}"),
        cancel,
        element(
            "progress", max=job.total or None, value=job.done if job.total else None, aria_label=job.title
        ),
        element("span", words_of(job), class_="fr-quiet fr-what"),
        class_="fr-job",
        data_fairyring_job=job.id,
    )


def progress_of(job: Job) -> JobProgress:
    """What the editor writes into the line."""
    return JobProgress(job=job.id, done=job.done, total=job.total, words=words_of(job))


def words_of(job: Job) -> str:
    """How far it is, and about how long it will take."""
    if not job.total:
        return job.what or "waits for its turn"
    left = job.seconds_left
    time = "" if left is None else f" · {about(left)} left"
    return f"{job.done} of {job.total}{time} · {job.what}"


def about(seconds: float) -> str:
    """A length of time as people say it."""
    if seconds < 60:
        return f"about {max(round(seconds), 1)} s"
    minutes = seconds / 60
    return f"about {round(minutes)} min" if minutes < 90 else f"about {minutes / 60:.1f} h"
