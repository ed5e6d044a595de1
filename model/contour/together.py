"""The `map` method: all caps of an image together, in three looks.

The first look fits every cap to what is surely its own rim. Each of the next two gives every border between
two caps to the one in front, or to both where they only touch, and fits again. So what a look says of a cap
depends on what the look before said of it and of those it meets, and of no others, but for the statistics of
the image, which are measured after the second look (`statistics.py`). `fitted_image.py` builds on that: to
give one cap another outline takes its neighbours and theirs, not the image.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from fairyring.model.contour.batch import first_caps
from fairyring.model.contour.contact import NOBODY, Contact
from fairyring.model.contour.expectation import Expected, corners_that_count, expected_reach
from fairyring.model.contour.harmonic import (
    Array,
    Estimate,
    Evidence,
    Outlines,
    coverage_of,
    fit_outlines,
)
from fairyring.model.contour.noise import FIRST_NOISE, LEAST_NOISE, expected_power
from fairyring.model.contour.order import meetings_of, seen_share
from fairyring.model.contour.priors import Priors
from fairyring.model.contour.rims import Rims
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.statistics import Statistics
from fairyring.model.geometry.told_arcs import NOT_TOLD, TOLD_KINDS

FIRST_GLANCE = 0.2
"""How probable it is that a border is one's own rim, before anything is known."""
LOOKS = 3
FIRST_SOFTNESS = (3.0, 2.0, 1.0, 1.0)
NEXT_SOFTNESS = (1.0, 1.0)
"""Steps of the fit of the first look and of those after decisions on the borders."""
IS_OWN_RIM = np.array([kind in ("visible", "contact") for kind in TOLD_KINDS], np.float64)
"""By the kind of an arc that a person named: where two caps touch, the border is the rim of both."""
HIDDEN_DOUBT = 0.6
"""Standard deviations grow by this share for a rim that is all hidden: borders may have been misjudged."""


@dataclass(frozen=True, slots=True)
class Look:
    """What a look says of n caps."""

    estimate: Estimate
    own: Array
    """(n, K), how probable it is that a rim point lies on the cap's own rim, as the fit was told."""


@dataclass(frozen=True, slots=True)
class Together:
    """n caps of an image after the last look."""

    rims: Rims
    contact: Contact
    """Neighbours by their index in ``in_sight``."""
    in_sight: Sequence[Silhouette]
    look: Look
    statistics: Statistics
    around: Outlines
    """The circles around what is visible."""

    @property
    def coverage(self) -> Array:
        """(n,), the share of the whole rim that is in sight."""
        return coverage_of(self.rims, self.look.estimate, self.look.own)

    @property
    def centre_sd(self) -> Array:
        """(n, 2), one standard deviation of the centre along x and y, pixels.

        No less than who drew the outline gives: a network's rim is smooth where it is wrong, too, so its
        roughness does not tell how far off it is.
        """
        estimate = self.look.estimate
        relative: Array = np.sqrt(estimate.covariance[:, [0, 1], [0, 1]])
        radius = np.exp(estimate.outlines.log_radius)
        own = relative * (radius * (1 + HIDDEN_DOUBT * (1 - self.coverage)))[:, None]
        caps = self.in_sight[: len(own)]
        return np.maximum(own, [cap.likely.centre_sd if cap.likely else (0.0, 0.0) for cap in caps])


def first_look(rims: Rims, contact: Contact, expected: Expected, priors: Priors) -> Look:
    """Fits n ≥ 1 caps, each by itself."""
    around = enclosing_circles(rims, priors)
    own = as_told(np.where(contact.neighbour == NOBODY, contact.free, FIRST_GLANCE), rims)
    evidence = Evidence(
        points=rims.points,
        weight=rims.spacing / expected_power(FIRST_NOISE, priors),
        seen=own,
        noise=FIRST_NOISE,
        corner=np.zeros(own.shape),
        reach=reaches_around(rims, around) + priors.size_shift,
        stretch=priors.stretch * priors.stretch_hidden,
        size=0.0,
        size_precision=0.0,
        expected=expected,
    )
    return Look(fit_outlines(evidence, around, priors, softness=FIRST_SOFTNESS), own)


def next_look(
    rims: Rims,
    contact: Contact,
    before: Look,
    statistics: Statistics,
    priors: Priors,
    *,
    expected: Expected,
) -> Look:
    """Fits the first n ≥ 1 of the caps given, by what the look before said of all of them.

    All that those n meet must be among them; ``expected`` is of those n.
    """
    caps = len(expected.mean)
    meetings = meetings_of(contact, rims, before.estimate, noise=statistics.noise)
    own = seen_share(contact, meetings)[:caps]
    rims, estimate = first_caps(rims, caps=caps), first_caps(before.estimate, caps=caps)
    own = as_told(own, rims)
    evidence = Evidence(
        points=rims.points,
        weight=rims.spacing / statistics.power,
        seen=own,
        noise=max(statistics.noise, LEAST_NOISE),
        corner=corners_that_count(rims.corner, coverage_of(rims, estimate, own)),
        reach=reaches_around(rims, enclosing_circles(rims, priors)) + priors.size_shift,
        stretch=statistics.stretch,
        size=statistics.size,
        size_precision=statistics.size_precision,
        expected=expected,
    )
    return Look(fit_outlines(evidence, estimate.outlines, priors, softness=NEXT_SOFTNESS), own)


def as_told(own: Array, rims: Rims) -> Array:
    """How probable it is that points (n, K) lie on the own rim: as people said, else as it was worked out."""
    return np.where(rims.told == NOT_TOLD, own, IS_OWN_RIM[rims.told])


def reaches_around(rims: Rims, around: Outlines) -> Array:
    """(n,), the expected logarithms of the longest radii, from the circles around the rims."""
    fill = rims.area / (np.pi * np.exp(2 * around.log_radius))
    return around.log_radius + expected_reach(fill)


def enclosing_circles(rims: Rims, priors: Priors) -> Outlines:
    """To start from: the circles around the visible rims."""
    origin = rims.points[:, 0]
    around = [
        cv2.minEnclosingCircle(rim) for rim in (rims.points - origin[:, None]).astype(np.float32, order="C")
    ]
    return Outlines(
        centre=origin + np.array([centre for centre, _ in around]),
        log_radius=np.log(np.maximum([radius for _, radius in around], 0.5)),
        shape=np.zeros((len(origin), 2 + 2 * len(priors.wobble))),
    )
