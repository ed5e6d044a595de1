"""The caps of an image, fitted together: the one place where whole outlines are worked out.

All caps, some, or one with another outline: each answer is, to the last digit, what fitting the whole image
with these outlines and these statistics gives, in whatever order they come.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from threading import RLock

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.batch import first_caps, joined, single_caps
from fairyring.model.contour.expectation import expected_of
from fairyring.model.contour.guarded import reconstructions_of
from fairyring.model.contour.layout import NEAR, Layout, changed_layout, empty_layout
from fairyring.model.contour.order import meetings_of, overlap_order
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.result import UNSEEN, Reconstruction
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.statistics import Statistics, measured_statistics, usual_statistics
from fairyring.model.contour.together import (
    LOOKS,
    Look,
    Together,
    enclosing_circles,
    first_look,
    next_look,
)
from fairyring.model.geometry.boxes import touching


class FittedImage:
    """The silhouettes of an image, what they touch, the image's statistics, and the looks taken so far.

    It never changes: `with_caps` makes another one, of the same statistics, which shares what holds for both.
    Looks are taken when they are first asked for, and remembered. Several threads may ask.
    """

    def __init__(
        self,
        layout: Layout,
        priors: Priors,
        statistics: Statistics | None = None,
    ) -> None:
        self._layout = layout
        self._priors = priors
        self._statistics = statistics
        self._looks: list[dict[Silhouette, Look]] = [{} for _ in range(LOOKS)]
        self._lock = RLock()

    @property
    def statistics(self) -> Statistics:
        """Those given, else measured on the caps this was first made with; the usual ones before that."""
        with self._lock:
            if self._statistics is None and self._layout.caps:
                self._statistics = self._measured()
            return self._statistics or usual_statistics(self._priors)

    def with_caps(self, caps: Iterable[Silhouette]) -> FittedImage:
        """The image as it is with these caps and no others; those with nothing to see are left out."""
        wanted, known = {cap for cap in caps if cap.pixels}, self._layout.rims.keys()
        if wanted == known:
            return self
        with self._lock:
            return self._changed(added=list(wanted - known), removed=known - wanted)

    def reconstructions(self, caps: Sequence[Silhouette]) -> list[Reconstruction]:
        """What is known of these caps of the image, in this order."""
        seen = list(dict.fromkeys(cap for cap in caps if cap.pixels))
        found = reconstructions_of(self.together(seen)) if seen else []
        known = dict(zip(seen, found, strict=True))
        return [known.get(cap, UNSEEN) for cap in caps]

    def together(self, caps: Sequence[Silhouette]) -> Together:
        """All that the last look says of n ≥ 1 different caps of the image."""
        with self._lock:
            self._take_look(LOOKS - 1, caps)
            look = joined([self._looks[-1][cap] for cap in caps])
        in_sight = [*caps, *self._neighbours(caps)]
        rims, contact = self._layout.batch(in_sight)
        rims, contact = first_caps(rims, caps=len(caps)), first_caps(contact, caps=len(caps))
        return Together(rims, contact, in_sight, look, self.statistics, enclosing_circles(rims, self._priors))

    def overlap_order(self) -> dict[Silhouette, tuple[int, float]]:
        """How far in front every cap lies, 0 the rearmost, and how sure that is, 0.5 to 1."""
        caps = self._layout.caps
        if not caps:
            return {}
        together = self.together(caps)
        noise = together.statistics.noise
        meetings = meetings_of(together.contact, together.rims, together.look.estimate, noise=noise)
        rank, confidence = overlap_order(meetings, caps=len(caps))
        return dict(zip(caps, zip(rank.tolist(), confidence.tolist(), strict=True), strict=True))

    def _take_look(self, nth: int, caps: Sequence[Silhouette]) -> None:
        """Makes sure that a look, and all before it, has been taken at these caps."""
        looks = self._looks[nth]
        missing = [cap for cap in caps if cap not in looks]
        if not missing:
            return
        if nth == 0:
            expected = expected_of([cap.likely for cap in missing])
            look = first_look(*self._layout.batch(missing), expected, self._priors)
        else:
            around = [*missing, *self._neighbours(missing)]
            self._take_look(nth - 1, around)
            before = joined([self._looks[nth - 1][cap] for cap in around])
            statistics = self.statistics if nth == LOOKS - 1 else usual_statistics(self._priors)
            rims, contact = self._layout.batch(around)
            expected = expected_of([cap.likely for cap in missing])
            look = next_look(rims, contact, before, statistics, self._priors, expected=expected)
        looks.update(zip(missing, single_caps(look, caps=len(missing)), strict=True))

    def _measured(self) -> Statistics:
        """By what the last look but one says of all caps."""
        caps = self._layout.caps
        self._take_look(LOOKS - 2, caps)
        look = joined([self._looks[LOOKS - 2][cap] for cap in caps])
        return measured_statistics(*self._layout.batch(caps), look.estimate, look.own, self._priors)

    def _neighbours(self, caps: Sequence[Silhouette]) -> set[Silhouette]:
        """The caps that any of these meets, besides themselves."""
        if len(caps) == len(self._layout.caps):
            return set()
        return {other for cap in caps for other in self._layout.neighbours(cap)}.difference(caps)

    def _changed(self, *, added: Sequence[Silhouette], removed: set[Silhouette]) -> FittedImage:
        layout, differ = changed_layout(self._layout, added=added, removed=removed)
        statistics = self.statistics if self._layout.caps else self._statistics
        image = FittedImage(layout, self._priors, statistics)
        if not self._looks[0]:
            return image
        stale = differ | removed
        for nth, (before, looks) in enumerate(zip(self._looks, image._looks, strict=True)):
            if nth > 0:
                # What a look says depends on what the one before said of the neighbours, old and new.
                old = {it for cap in stale if cap in self._layout.rims for it in self._layout.neighbours(cap)}
                new = {it for cap in stale if cap in layout.rims for it in layout.neighbours(cap)}
                stale = stale | old | new
            looks.update(before)
            for cap in stale:
                looks.pop(cap, None)
        return image


def within_reach(boxes: NDArray[np.float64], wanted: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(n,), which caps can matter to the wanted ones (n,), by the boxes (n, 4) of their outlines, pixels.

    The others may be left out of the image without a change in what is known of the wanted ones.
    """
    near = wanted
    # Outlines are rounded out to whole pixels.
    margin = np.array([-1, -1, 1, 1]) * (NEAR + 2)
    for _ in range(LOOKS):
        near = np.logical_or.reduce(touching(boxes[near] + margin, boxes), axis=0)
    return near


def fitted_image(
    caps: Iterable[Silhouette],
    *,
    width: int,
    height: int,
    priors: Priors = DEFAULT,
    statistics: Statistics | None = None,
) -> FittedImage:
    """Of an image of this size with these caps. Its ``statistics`` are measured where none are given."""
    return FittedImage(empty_layout(width=width, height=height), priors, statistics).with_caps(caps)
