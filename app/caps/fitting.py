"""Keeps the fitted image of an open photo or a command up to date as its outlines change."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import asdict
from threading import Lock

import msgspec

from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.priors import DEFAULT
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.contour.statistics import Statistics, usual_statistics
from fairyring.storage.records import Image, Outline

MOST_SPARE = 200
"""How many silhouettes of former outlines are kept: a drag makes many, and may go back."""


class Fitting:
    """Reconstructs the caps of one image, and remembers what the next question will need again.

    Outlines are never changed in place: the same list is the same outline. Several threads may ask.
    """

    def __init__(self, image: Image, statistics: Statistics | None) -> None:
        """Fits by these statistics; None measures them on the outlines that are first visible."""
        self._image = image
        self._silhouettes: dict[int, tuple[Outline, Silhouette]] = {}
        self._latest = fitted_image([], width=image.width, height=image.height, statistics=statistics)
        self._lock = Lock()

    @property
    def statistics(self) -> dict[str, float]:
        """The statistics it fits by, to be kept as ``image.statistics``."""
        return asdict(self._latest.statistics)

    def reconstructions(
        self, wanted: Sequence[Outline], *, visible: Collection[Outline]
    ) -> list[Reconstruction]:
        """Reconstructs some outlines among all those ``visible`` in the image; all were checked before."""
        with self._lock:
            caps = {id(outline): self._silhouette(outline) for outline in visible}
            self._latest = self._latest.with_caps(caps.values())
            if len(self._silhouettes) > len(caps) + MOST_SPARE:
                self._silhouettes = {key: self._silhouettes[key] for key in caps}
            return self._latest.reconstructions([self._silhouette(outline) for outline in wanted])

    def _silhouette(self, outline: Outline) -> Silhouette:
        known = self._silhouettes.get(id(outline))
        if known is None:
            size = {"width": self._image.width, "height": self._image.height}
            known = self._silhouettes[id(outline)] = outline, silhouette_of_outline(outline, **size)
        return known[1]


def known_statistics(image: Image) -> Statistics:
    """The statistics measured on an image; the usual ones where there are none that this version knows."""
    with suppress(msgspec.ValidationError):
        return msgspec.convert(image.statistics, Statistics)
    return usual_statistics(DEFAULT)
