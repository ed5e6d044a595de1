"""The reviewer's queue: which images to go through and in which order, and how far that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import viser
from sqlalchemy import Connection

from fairyring.app.how_many import how_many
from fairyring.app.live.queues import approve_rest, begin_queue, leave_queue
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import SIGNS
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
from fairyring.model.evaluate.acceptance import sample_size
from fairyring.storage.candidates import (
    candidates,
    count_candidates,
    count_waiting,
    people,
)
from fairyring.storage.queues import decisions_in, queue_of
from fairyring.storage.records import Queue

ANYBODY = "anybody"


@dataclass(frozen=True)
class _Shown:
    queue: Queue | None
    standing: Standing | None
    waiting: int
    """How many images could be gone through."""
    people: list[str]


class _Choice:
    """The controls that say which images a queue is to hold."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self.order = gui.add_dropdown("Queue by", (*ORDERS, EDITED, SAMPLE))
        self.person = gui.add_dropdown("Annotator", [str(ANYBODY)])
        self.unfinished = gui.add_checkbox(
            "Unfinished too", initial_value=False, hint="Also images with caps that nobody called annotated"
        )
        self.confidence = gui.add_number("Confidence %", 95.0, min=50.0, max=99.9, step=0.1, visible=False)
        self.tolerated = gui.add_number("Wrong at most %", 5.0, min=0.0, max=50.0, step=0.5, visible=False)
        self.allowed = gui.add_number("Wrong in sample", 0, min=0, max=50, step=1, visible=False)
        self.seed = gui.add_number("Seed", 1, min=0, step=1, visible=False)

    @property
    def of_sample(self) -> Sequence[viser.GuiInputHandle[Any]]:
        """Those that are about a random sample."""
        return self.confidence, self.tolerated, self.allowed, self.seed

    @property
    def all(self) -> Sequence[viser.GuiInputHandle[Any]]:
        return self.order, self.person, self.unfinished, *self.of_sample

    @property
    def is_sample(self) -> bool:
        return self.order.value == SAMPLE

    @property
    def images(self) -> dict[str, Any]:
        """Which images may be in it."""
        whose = None if self.person.value == ANYBODY else self.person.value
        return {"annotator": whose, "unfinished": self.unfinished.value}

    @property
    def plan(self) -> dict[str, Any]:
        """What a sample is to find out."""
        shares = {"tolerated": self.tolerated.value / 100, "confidence": self.confidence.value / 100}
        return {"allowed": int(self.allowed.value)} | shares

    @property
    def title(self) -> str:
        by = "" if self.person.value == ANYBODY else f", by {self.person.value}"
        return f"{self.order.value}{by}"


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the queue's controls and what is said of it."""
    gui = session.client.gui
    shown = gui.add_html("")
    with gui.add_folder("Queue", expand_by_default=False):
        choice = _Choice(gui)
        size = gui.add_html("")
        begin = gui.add_button("Begin")
    rest = gui.add_button("Approve the others", visible=False)
    end = gui.add_button("End the queue", visible=False)

    async def start() -> None:
        found = await workspace.read(partial(candidates, **choice.images))
        if choice.is_sample:
            images, plan = sampled(found, **choice.plan, seed=int(choice.seed.value))
        else:
            images, plan = ordered(found, choice.order.value), None
        stale = sum(not each.compared for each in found)
        if stale and choice.order.value in NEED_COMPARISONS:
            session.notify(
                f"Not compared with the predictions as they are now: {how_many(stale, 'image')}. "
                "“Bring up to date” first.",
                "warning",
            )
        await begin_queue(workspace, session, choice.title, images, plan)

    async def tell_size() -> None:
        reopened = choice.order.value == EDITED
        lot = await workspace.read(partial(count_candidates, **choice.images, reopened=reopened))
        sample = sample_size(lot, **choice.plan) if lot and choice.is_sample else None
        size.content = size_words(lot, sample=sample).html
        begin.disabled = lot == 0

    async def choose() -> None:
        for control in choice.of_sample:
            control.visible = choice.is_sample
        await tell_size()

    async def redraw() -> None:
        now = await workspace.read(partial(_load, user=session.user))
        people = (ANYBODY, *now.people)
        if tuple(choice.person.options) != people:
            choice.person.options = people
        shown.content = queue_line(now.queue, now.standing, waiting=now.waiting).html
        end.visible = now.queue is not None
        passed = now.queue is not None and now.standing is not None and has_passed(now.queue, now.standing)
        begin.label = "Begin another" if now.queue else "Begin"
        if now.queue is None:
            await tell_size()
        else:
            size.content = ""
        rest.visible = passed
        if passed and now.queue is not None:
            rest.label = f"Approve the other {len(rest_of(now.queue))}"

    for control in choice.all:
        control.on_update(person_did(session, choose))
    begin.on_click(person_did(session, start))
    end.on_click(person_did(session, partial(leave_queue, workspace, session)))
    rest.on_click(person_did(session, partial(approve_rest, workspace, session)))
    return redraw


def _load(connection: Connection, *, user: str) -> _Shown:
    queue = queue_of(connection, user)
    standing = standing_of(queue, decisions_in(connection, queue)) if queue else None
    return _Shown(queue, standing, count_waiting(connection), people(connection))


def size_words(lot: int, *, sample: int | None) -> Markup:
    """How many images a queue would hold, and how many of them a sample; None where none is drawn."""
    words = "1 image fits this queue." if lot == 1 else f"{lot} images fit this queue."
    if not lot:
        words = "No image fits this queue: choose another order or annotator."
    elif sample is not None:
        words = f"{sample} of {how_many(lot, 'image')} {'has' if sample == 1 else 'have'} to be looked at"
    return element("div", words, class_="fr-review fr-quiet", role="status")


def queue_line(queue: Queue | None, standing: Standing | None, *, waiting: int) -> Markup:
    """How many images wait, or how far the queue is and how often the reviewer agreed."""
    if queue is None or standing is None:
        return element("div", waiting_words(waiting), class_="fr-review fr-queue")
    return element(
        "div",
        element("div", element("strong", queue.title), class_="fr-line"),
        element("div", progress_words(standing)),
        element("div", _tally(standing), class_="fr-quiet") if standing.done else None,
        element("div", _verdict_on_lot(queue, standing), class_="fr-quiet") if queue.plan else None,
        class_="fr-review fr-queue",
    )


def waiting_words(waiting: int) -> str:
    """How many images wait, as a sentence."""
    if not waiting:
        return "No image waits for a review."
    return "1 image waits for a review." if waiting == 1 else f"{waiting} images wait for a review."


def _tally(standing: Standing) -> str:
    counted = (
        (standing.approved, "approved"),
        (standing.sent_back, "sent back"),
        (standing.rejected, "rejected"),
    )
    return " · ".join(f"{SIGNS[word]} {count} {word}" for count, word in counted if count)


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
