"""The panel's header: the image, the run, the user, and work in progress. The editor itself shows whether all
is saved, and its buttons which status the image has."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.jobs.runner import Job
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.buttons import command_button
from fairyring.app.panels.callbacks import Redraw
from fairyring.app.panels.job_progress import progress_line
from fairyring.app.panels.markup import Markup, element
from fairyring.storage.records import Image, Run, Says, Status
from fairyring.storage.verdicts import given_back

STATUS_WORDS: dict[Status, str] = {"new": "to do", "annotated": "annotated", "approved": "approved"}
SAID_WORDS: dict[Says, str] = {"rejected": "rejected", "sent_back": "sent back"}
"""What is said of an image that is to do again."""
SIGNS = {"to do": "○", "annotated": "◐", "approved": "✓", "sent back": "↩", "rejected": "✗"}
STATUS_OF_WORD: dict[str, Status] = {word: status for status, word in STATUS_WORDS.items()}


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the header."""
    shown = session.client.gui.add_html("")

    async def redraw() -> None:
        image = session.image
        said = {} if image is None else await workspace.read(lambda c: given_back(c, [image.id]))
        now = header(
            session,
            project=workspace.project.name,
            jobs=workspace.jobs.running,
            said=said.get(image.id) if image else None,
        )
        shown.content = now.html

    return redraw


def status_badge(image: Image, said: Says | None) -> Markup:
    """What people say of an image, with a sign; one that was rejected or sent back is called so."""
    word = status_word(image.status, said)
    look = said if word in SAID_WORDS.values() else image.status
    return element("span", f"{SIGNS[word]} {word}", class_=f"fr-badge fr-{look}", title="Status of the image")


def status_word(status: Status, said: Says | None) -> str:
    """How far an image is; one to do that was last rejected or sent back is called so."""
    return SAID_WORDS.get(said, STATUS_WORDS[status]) if said and status == "new" else STATUS_WORDS[status]


def header(session: Session, *, project: str, jobs: Sequence[Job], said: Says | None = None) -> Markup:
    """The header of a tab as it is now, with the jobs at work and what was last said of the image."""
    return element(
        "header",
        element("div", *_image_line(session, said), class_="fr-line"),
        element("div", *_person_line(session, project), class_="fr-line fr-quiet"),
        element("div", *_work_line(session), class_="fr-line fr-quiet"),
        *(progress_line(job, own=job.may_be_cancelled_by(session.user)) for job in jobs),
        class_="fr-header",
    )


def _image_line(session: Session, said: Says | None) -> list[Markup]:
    image = session.image
    if image is None:
        return [element("strong", "No image open")]
    return [
        command_button("previous_image", class_="fr-step"),
        element("strong", image.file_name, class_="fr-ellipsis", title=image.file_name),
        status_badge(image, said),
        element("span", f"{session.position + 1} of {session.count}", class_="fr-quiet fr-push"),
        command_button("next_image", class_="fr-step"),
    ]


def _progress() -> Markup:
    """How many caps are checked and how long the rest may take: the editor writes it."""
    return element("span", data_fairyring_progress="", class_="fr-progress fr-push", title="Caps checked")


def _person_line(session: Session, project: str) -> list[Markup]:
    return [
        element("span", project, class_="fr-ellipsis", title=f"The project {project}"),
        element(
            "a",
            session.user,
            href="/name",
            title=f"Not {session.user}? Change the name",
            class_="fr-ellipsis fr-push",
        ),
    ]


def _work_line(session: Session) -> list[Markup]:
    run = session.run
    waiting = f"{session.waiting} on their way" if session.waiting else None
    return [
        run_badge(run) if run else element("span", "no predictions"),
        element(
            "span",
            waiting,
            class_="fr-badge fr-warn" if waiting else None,
            title="Edits not acknowledged yet",
        ),
        _progress(),
    ]


def run_badge(run: Run) -> Markup:
    """A run's name; simulated predictions are called so, and what a second annotator labelled."""
    if run.kind == "simulated":
        warning = (
            "These predictions are true masks distorted by a noise model; no network has seen the photo."
        )
        return element("span", "simulated predictions", class_="fr-badge fr-warn", title=warning)
    words = f"predicted by {run.name}" if run.kind == "network" else run.name
    what = "Labelled by a second annotator" if run.kind == "second" else "Predictions"
    return element("span", words, class_="fr-badge fr-ellipsis", title=f"{what}: {run.name}, {run.made_at}")
