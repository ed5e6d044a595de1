"""The reviewer's queue: which images to go through and in which order, and how far that is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.queues import approve_rest, begin_queue, leave_queue
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.review.queueing import (
    EDITED,
    NEED_COMPARISONS,
    ORDERS,
    SAMPLE,
    Standing,
    has_passed,
    ordered,
    rest_of,
    sampled,
    standing_of,
)
from fairyring.storage.candidates import Candidate, candidates, count_waiting, people
from fairyring.storage.queues import decisions_in, queue_of
from fairyring.storage.records import Queue, SamplingPlan

ANYBODY = "anybody"


@dataclass(frozen=True)
class _Shown:
    queue: Queue | None
    standing: Standing | None
    waiting: int
    """How many images could be gone through."""
    people: list[str]


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the queue's controls and what is said of it."""
    gui = session.client.gui
    shown = gui.add_html("")
    with gui.add_folder("Queue", expand_by_default=False):
        order = gui.add_dropdown("Queue by", (*ORDERS, EDITED, SAMPLE))
        person = gui.add_dropdown("Annotator", [str(ANYBODY)])
        unfinished = gui.add_checkbox(
            "Unfinished too", initial_value=False, hint="Also images with caps that nobody called annotated"
        )
        confidence = gui.add_number("Confidence %", 95.0, min=50.0, max=99.9, step=0.1, visible=False)
        tolerated = gui.add_number("Wrong at most %", 5.0, min=0.0, max=50.0, step=0.5, visible=False)
        allowed = gui.add_number("Wrong in sample", 0, min=0, max=50, step=1, visible=False)
        seed = gui.add_number("Seed", 1, min=0, step=1, visible=False)
        size = gui.add_html("", visible=False)
        begin = gui.add_button("Begin")
    rest = gui.add_button("Approve the others", visible=False)
    end = gui.add_button("End the queue", visible=False)

    def wanted(connection: Connection) -> list[Candidate]:
        by = None if person.value == ANYBODY else person.value
        return candidates(connection, annotator=by, unfinished=unfinished.value)

    def drawn(found: list[Candidate]) -> tuple[list[int], SamplingPlan]:
        shares = {"tolerated": tolerated.value / 100, "confidence": confidence.value / 100}
        return sampled(found, allowed=int(allowed.value), **shares, seed=int(seed.value))

    async def start() -> None:
        found = await workspace.read(wanted)
        if order.value == SAMPLE:
            images, plan = drawn(found)
        else:
            images, plan = ordered(found, order.value), None
        stale = sum(not each.compared for each in found)
        if stale and order.value in NEED_COMPARISONS:
            session.notify(
                f"{stale} images are not compared with the predictions as they are now: "
                "“Bring up to date” first.",
                "warning",
            )
        whose = "" if person.value == ANYBODY else f", by {person.value}"
        await begin_queue(workspace, session, f"{order.value}{whose}", images, plan)

    async def choose() -> None:
        for control in (confidence, tolerated, allowed, seed, size):
            control.visible = order.value == SAMPLE
        if order.value == SAMPLE:
            found = await workspace.read(wanted)
            size.content = _size(len(drawn(found)[0]), len(found)).html

    async def redraw() -> None:
        now = await workspace.read(partial(_load, user=session.user))
        people = (ANYBODY, *now.people)
        if tuple(person.options) != people:
            person.options = people
        shown.content = queue_line(now.queue, now.standing, waiting=now.waiting).html
        end.visible = now.queue is not None
        passed = now.queue is not None and now.standing is not None and has_passed(now.queue, now.standing)
        rest.visible = passed
        if passed and now.queue is not None:
            rest.label = f"Approve the other {len(rest_of(now.queue))}"

    for control in (order, person, unfinished, confidence, tolerated, allowed, seed):
        control.on_update(person_did(session, choose))
    begin.on_click(person_did(session, start))
    end.on_click(person_did(session, partial(leave_queue, workspace, session)))
    rest.on_click(person_did(session, partial(approve_rest, workspace, session)))
    return redraw


def _load(connection: Connection, *, user: str) -> _Shown:
    queue = queue_of(connection, user)
    standing = standing_of(queue, decisions_in(connection, queue)) if queue else None
    return _Shown(queue, standing, count_waiting(connection), people(connection))


def _size(size: int, lot: int) -> Markup:
    return element("div", f"{size} of {lot} images have to be looked at", class_="fr-review fr-quiet")


def queue_line(queue: Queue | None, standing: Standing | None, *, waiting: int) -> Markup:
    """How many images wait, or how far the queue is and how often the reviewer agreed."""
    if queue is None or standing is None:
        words = f"{waiting} images wait for a review." if waiting else "No image waits for a review."
        return element("div", words, class_="fr-review fr-queue")
    return element(
        "div",
        element("div", element("strong", queue.title), class_="fr-line"),
        element("div", progress_words(standing)),
        element("div", _verdict_on_lot(queue, standing), class_="fr-quiet") if queue.plan else None,
        class_="fr-review fr-queue",
    )


def progress_words(standing: Standing) -> str:
    """How many are done, and the share approved with its interval."""
    told = f"{standing.done} of {standing.of} done"
    if standing.agreement is None:
        return told
    low, high = standing.interval
    return f"{told}, agreement {100 * standing.agreement:.0f} % ({100 * low:.0f} to {100 * high:.0f} %)"


def _verdict_on_lot(queue: Queue, standing: Standing) -> str:
    assert queue.plan is not None, "asked of samples alone"
    if standing.wrong > queue.plan.allowed:
        return f"{standing.wrong} wrong, {queue.plan.allowed} allowed: look at all {len(queue.plan.lot)}."
    if has_passed(queue, standing):
        return f"{standing.wrong} wrong, {queue.plan.allowed} allowed: the others may be approved."
    return f"{standing.wrong} wrong so far, {queue.plan.allowed} allowed."
