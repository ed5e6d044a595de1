"""Which images a reviewer goes through, and in which order."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from typing import Any

from msgspec import Struct

from fairyring.model.evaluate.acceptance import sample_size
from fairyring.model.evaluate.intervals import wilson_interval
from fairyring.storage.candidates import Candidate
from fairyring.storage.records import Queue, SamplingPlan, Says

ORDERS: dict[str, Callable[[Candidate], Any]] = {
    "CDR over its floor": lambda each: -_or_least(each.excess),
    "least overlap": lambda each: 1.0 if each.iou is None else each.iou,
    "most missed": lambda each: -each.missed,
    "most extra": lambda each: -each.extra,
    "network least sure": lambda each: -each.doubt,
    "name": lambda _: 0,
}
"""What comes first; images that are alike in it are in the order of their names."""
NEED_COMPARISONS = {"CDR over its floor", "least overlap", "most missed", "most extra"}
EDITED = "edited since approved"
SAMPLE = "random sample"


class Standing(Struct, frozen=True, kw_only=True):
    """How far a queue is."""

    done: int
    of: int
    approved: int
    sent_back: int = 0
    rejected: int = 0
    interval: tuple[float, float]
    """Of the share that was approved, with 95 % confidence."""

    @property
    def wrong(self) -> int:
        return self.done - self.approved

    @property
    def agreement(self) -> float | None:
        """Share of the images looked at that was approved; None before the first."""
        return self.approved / self.done if self.done else None


def ordered(found: Sequence[Candidate], order: str) -> list[int]:
    """The images in one of ``ORDERS``; of ``EDITED`` only those that were edited since they were approved."""
    if order == EDITED:
        return [each.image for each in found if each.reopened]
    return [each.image for each in sorted(found, key=ORDERS[order])]


def sampled(
    found: Sequence[Candidate], *, allowed: int, tolerated: float, confidence: float, seed: int
) -> tuple[list[int], SamplingPlan]:
    """A random sample, as large as it has to be, and its plan.

    Raises:
        FairyringError: the plan makes no sense.
    """
    lot = [each.image for each in found]
    size = sample_size(len(lot), allowed=allowed, tolerated=tolerated, confidence=confidence)
    plan = SamplingPlan(lot=lot, allowed=allowed, tolerated=tolerated, confidence=confidence)
    return random.Random(seed).sample(lot, size), plan


def standing_of(queue: Queue, decisions: dict[int, Says]) -> Standing:
    """How far a queue is after these decisions."""
    approved = sum(says == "approved" for says in decisions.values())
    return Standing(
        done=len(decisions),
        of=len(queue.images),
        approved=approved,
        sent_back=sum(says == "sent_back" for says in decisions.values()),
        rejected=sum(says == "rejected" for says in decisions.values()),
        interval=wilson_interval(approved, len(decisions)),
    )


def has_passed(queue: Queue, standing: Standing) -> bool:
    """Whether a sample is through and allows for the rest of its lot to be approved."""
    plan = queue.plan
    return plan is not None and standing.done == standing.of and standing.wrong <= plan.allowed


def rest_of(queue: Queue) -> list[int]:
    """The images of a sample's lot that are not in the sample."""
    seen = set(queue.images)
    return [] if queue.plan is None else [number for number in queue.plan.lot if number not in seen]


def _or_least(value: float | None) -> float:
    return float("-inf") if value is None else value
