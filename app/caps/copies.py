"""Copies of open images' caps in the processes that work out fits.

A request carries what has changed since the last one, so that a question about one of five hundred caps
takes no five hundred outlines along.
"""

from __future__ import annotations

import asyncio
import itertools
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from fairyring.app.caps.fitting import Fitting, Likely, known_statistics
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.workers.worker import ASKED, Task, Worker
from fairyring.storage.records import Annotation, Image, Prediction

MOST_KEPT = 32
"""Most copies in one process; those asked about last stay."""

Found = TypeVar("Found")
_numbers = itertools.count(1)


class LostCopyError(Exception):
    """The process has no such copy: it is another one, or kept others."""


@dataclass(frozen=True, kw_only=True)
class Update:
    """What makes a copy the caps that are asked about."""

    number: int
    image: Image
    annotations: Mapping[str, Annotation]
    """All of them, or those that have changed."""
    predictions: Sequence[Prediction] | None
    """None where these are the same, and the copy is only brought up to date."""
    likely: Likely
    """What networks said of whole outlines; empty where ``predictions`` is None."""


class Copy:
    """The copy of the caps that one tab shows."""

    def __init__(self) -> None:
        self._number = next(_numbers)
        self._sent: dict[tuple[Worker, int], ImageCaps] = {}

    async def ask(
        self,
        worker: Worker,
        caps: ImageCaps,
        work: Callable[..., Found],
        /,
        *given: Any,
        urgency: int = ASKED,
    ) -> Found:
        """What a function makes of these caps, worked out by a worker.

        Cancelled, it is not worked out. Raises what the function raises, and WorkerError.
        """

        def task() -> Task:
            process = worker, worker.started
            update = self._update(self._sent.get(process), caps)
            self._sent[process] = caps
            return answer_about, (update, work, given)

        try:
            return await asyncio.wrap_future(worker.ask(task, urgency=urgency))
        except LostCopyError:
            self._sent.clear()
            return await asyncio.wrap_future(worker.ask(task, urgency=urgency))

    def _update(self, sent: ImageCaps | None, caps: ImageCaps) -> Update:
        if sent is None or not _goes_on(sent, caps):
            changed, predictions, likely = dict(caps.annotations), caps.predictions, caps.fitting.likely
        else:
            before, predictions, likely = sent.annotations, None, {}
            changed = {uid: now for uid, now in caps.annotations.items() if before.get(uid) is not now}
        return Update(
            number=self._number,
            image=caps.image,
            annotations=changed,
            predictions=predictions,
            likely=likely,
        )


def _goes_on(sent: ImageCaps, caps: ImageCaps) -> bool:
    """Whether only annotations were added or changed since."""
    if sent.fitting is not caps.fitting or sent.predictions is not caps.predictions:
        return False
    return sent.annotations.keys() <= caps.annotations.keys()


_kept: OrderedDict[int, ImageCaps] = OrderedDict()


def answer_about(update: Update, work: Callable[..., Any], given: tuple[Any, ...]) -> Any:
    """Brings a copy up to date, in the process that keeps it, and asks about it. Raises LostCopyError."""
    return work(_brought_up_to_date(update), *given)


def _brought_up_to_date(update: Update) -> ImageCaps:
    before = _kept.pop(update.number, None)
    if update.predictions is not None:
        fitting = Fitting(update.image, known_statistics(update.image), update.likely)
        caps = ImageCaps(update.image, update.annotations, update.predictions, fitting)
    elif before is None:
        raise LostCopyError
    elif update.annotations:
        caps = before.with_annotations({**before.annotations, **update.annotations})
    else:
        caps = before
    _kept[update.number] = caps
    while len(_kept) > MOST_KEPT:
        _kept.popitem(last=False)
    return caps
