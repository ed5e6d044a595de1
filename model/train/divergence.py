"""Notices a training whose loss has left all bounds: its weights know nothing any more."""

from __future__ import annotations

from dataclasses import dataclass, field
from statistics import median

from fairyring.model.errors import FairyringError

ITERATIONS = 5
"""Iterations over which the start is judged, and what came of it: single batches differ much."""
FAR = 20
"""A loss so many times that of the start is no accident …"""
HIGH = 10.0
"""… unless it is below this: where there is nothing to learn, next to nothing is many times nothing."""


class DivergenceError(FairyringError):
    """A loss far above the start's; the sentence says what to look at."""


@dataclass(kw_only=True)
class Losses:
    """The losses of the first iterations, and of the last."""

    first: list[float] = field(default_factory=list)
    last: list[float] = field(default_factory=list)

    def add(self, loss: float, *, iteration: int) -> None:
        """One more. Raises DivergenceError where the last ones are far above the first."""
        if len(self.first) < ITERATIONS:
            self.first.append(loss)
            return
        self.last = [*self.last, loss][-ITERATIONS:]
        start, now = median(self.first), median(self.last)
        if len(self.last) == ITERATIONS and now > HIGH and now > FAR * start:
            raise DivergenceError(
                f"The loss is {now:.0f} at iteration {iteration}, and it began at {start:.2g}: "
                "what the network knew is lost. Look whether photos of which only some caps are labelled "
                "count as complete, or lower the rate; then train into a new folder."
            )
