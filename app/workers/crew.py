"""The processes of a served project: for what people wait for, for what can wait, and for photos."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from fairyring.app.workers.worker import Worker
from fairyring.model.processes import usable_cores

MOST_FOR_FITS = 4
"""Most processes for fits: the one that answers everybody keeps no more of them busy."""
A_LITTLE_NICE, NICE = 1, 10
LOOKING_S = 900.0
"""A network may look at a large photo for so long, on a machine without a GPU that is busy."""
"""Answering comes before computing, and what people wait for before what they do not."""

Found = TypeVar("Found")


class Run(Protocol):
    """Calls a function with what it is given, perhaps in another process, and waits for what it returns."""

    def __call__(self, work: Callable[..., Found], /, *given: Any) -> Found: ...


def here(work: Callable[..., Found], /, *given: Any) -> Found:
    """Calls it in this process."""
    return work(*given)


@dataclass(frozen=True)
class Crew:
    """The workers, each started when it is first asked."""

    fits: Sequence[Worker]
    """What people wait for with a cap in hand. An image has always the same one, which remembers it."""
    bulk: Worker
    """Change sets of many edits: people wait for them, but with no cap in hand."""
    patient: Worker
    """Whole images: before exports, after predictions, against their predictions."""
    photos: Worker
    """Photos that no browser shows as they are, and smaller copies."""
    network: Worker
    """The network's caps at points: it keeps the network, and what that saw in the photo people point at."""

    def of_image(self, image_id: int) -> Worker:
        """Who works out the fits of this image."""
        return self.fits[image_id % len(self.fits)]

    def close(self) -> None:
        """Ends all of them."""
        for worker in (*self.fits, self.bulk, self.patient, self.photos, self.network):
            worker.close()


def crew(*, apart: bool) -> Crew:
    """As many as this machine's cores are good for; without ``apart`` all work in threads of this process."""
    count = min(max(usable_cores() - 1, 1), MOST_FOR_FITS)
    return Crew(
        fits=[Worker(f"fits-{number}", nice=A_LITTLE_NICE, apart=apart) for number in range(count)],
        bulk=Worker("bulk", nice=A_LITTLE_NICE, apart=apart),
        patient=Worker("patient", nice=NICE, apart=apart),
        photos=Worker("photos", nice=NICE, apart=apart),
        # It looks at photos before anybody points, while somebody may have a cap in hand.
        network=Worker("network", nice=NICE, apart=apart, patience_s=LOOKING_S),
    )
