"""Keeps the fitted image of an open photo or a command up to date as its outlines change."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from threading import Lock

import msgspec
import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.fitted_image import fitted_image, within_reach
from fairyring.model.contour.priors import DEFAULT
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.contour.statistics import Statistics, usual_statistics
from fairyring.model.geometry.boxes import Box, box_of_outline
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Fit
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage.records import Image, Outline

MOST_SPARE = 200
"""How many former outlines are remembered: a drag makes many, and may go back."""

Likely = Mapping[tuple[tuple[float, ...], ...], LikelyEllipse]
"""The whole ellipse that a network said of an outline it drew, by the points of its parts. It holds for this
very outline: where a person has moved the rim, the network was wrong."""
NOTHING_SAID: Likely = {}


def likely_by_outline(said: Iterable[tuple[Outline, LikelyEllipse | None]]) -> Likely:
    """Of outlines and the whole ellipses that were said of them, as far as any were."""
    return {_points(outline): whole for outline, whole in said if whole is not None}


def _points(outline: Outline) -> tuple[tuple[float, ...], ...]:
    return tuple(map(tuple, outline))


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What is visible of a cap, and what people said of pieces of that."""

    outline: Outline
    told: Sequence[ToldArc] = ()

    @property
    def key(self) -> tuple[int, int]:
        """Tells it apart from others; the same lists are the same."""
        return id(self.outline), id(self.told)


@dataclass(slots=True)
class _Known:
    """What is remembered of an outline."""

    seen: Seen
    box: Box
    silhouette: Silhouette | None = None
    """None until it is first needed."""


@dataclass(frozen=True, slots=True)
class _Crowd:
    """What was visible when something was last asked."""

    seen: tuple[Seen, ...] | None
    """None where it may have changed since."""
    known: Sequence[_Known]
    boxes: NDArray[np.float64]
    """(n, 4)."""


class Fitting:
    """Reconstructs the caps of one image, and remembers what the next question will need again.

    Outlines, and what was said of them, are never changed in place: the same list is the same. Several
    threads may ask.
    """

    def __init__(self, image: Image, statistics: Statistics | None, likely: Likely = NOTHING_SAID) -> None:
        """Fits by these statistics; None measures them on the outlines that are first visible."""
        self.likely = likely
        self._image = image
        self._outlines: dict[tuple[int, int], _Known] = {}
        self._crowd: _Crowd | None = None
        self._measured = statistics is not None
        self._latest = fitted_image([], width=image.width, height=image.height, statistics=statistics)
        self._lock = Lock()

    @property
    def statistics(self) -> dict[str, float]:
        """The statistics it fits by, to be kept as ``image.statistics``."""
        return asdict(self._latest.statistics)

    def reconstructions(self, wanted: Sequence[Seen], *, visible: Collection[Seen]) -> list[Reconstruction]:
        """Reconstructs some outlines among all those ``visible`` in the image; all were checked before.

        Those wanted may be among the visible ones or not. Of a tuple that was visible the last time, too,
        nothing is looked up again: of two thousand caps that takes as long as the fit of one.
        """
        with self._lock:
            if self._crowd is None or self._crowd.seen is not visible:
                self._crowd = self._crowd_of(visible)
            crowd, own = self._crowd.known, [self._known(seen) for seen in wanted]
            near = self._near(own, self._crowd.boxes) if self._measured else [True] * len(crowd)
            # What was near once stays: it costs nothing, and may be near again.
            shown = [each for each, is_near in zip(crowd, near, strict=True) if is_near or each.silhouette]
            self._latest = self._latest.with_caps([self._silhouette(each) for each in (*shown, *own)])
            self._measured = True
            found = self._latest.reconstructions([self._silhouette(each) for each in own])
            if len(self._outlines) > len(crowd) + len(own) + MOST_SPARE:
                self._outlines = {each.seen.key: each for each in (*crowd, *own)}
            return found

    def _crowd_of(self, visible: Collection[Seen]) -> _Crowd:
        known = [self._known(seen) for seen in visible]
        boxes = np.array([each.box for each in known], np.float64).reshape(-1, 4)
        # A list may hold others the next time.
        return _Crowd(visible if isinstance(visible, tuple) else None, known, boxes)

    @staticmethod
    def _near(wanted: Sequence[_Known], boxes: NDArray[np.float64]) -> list[bool]:
        """Of each box of a crowd (n, 4), whether its cap can matter to those wanted."""
        own = np.array([each.box for each in wanted], np.float64).reshape(-1, 4)
        is_wanted = np.arange(len(boxes) + len(own)) >= len(boxes)
        return within_reach(np.concatenate([boxes, own]), is_wanted)[: len(boxes)].tolist()

    def _known(self, seen: Seen) -> _Known:
        known = self._outlines.get(seen.key)
        if known is None:
            known = self._outlines[seen.key] = _Known(seen, box_of_outline(seen.outline))
        return known

    def _silhouette(self, known: _Known) -> Silhouette:
        if known.silhouette is None:
            seen, size = known.seen, {"width": self._image.width, "height": self._image.height}
            likely = self.likely.get(_points(seen.outline)) if self.likely else None
            known.silhouette = silhouette_of_outline(seen.outline, likely=likely, told=seen.told, **size)
        return known.silhouette


def fitted_anew(
    image: Image, outlines: Sequence[Outline], likely: Likely = NOTHING_SAID
) -> tuple[list[Fit], dict[str, float]]:
    """The whole outlines of all caps of an image, by statistics measured on them, and those statistics."""
    fitting, seen = Fitting(image, None, likely), [Seen(outline) for outline in outlines]
    found = fitting.reconstructions(seen, visible=seen)
    return [each.fit for each in found], fitting.statistics


def known_statistics(image: Image) -> Statistics:
    """The statistics measured on an image; the usual ones where there are none that this version knows."""
    with suppress(msgspec.ValidationError):
        return msgspec.convert(image.statistics, Statistics)
    return usual_statistics(DEFAULT)
