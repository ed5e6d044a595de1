"""What is measured on all caps of an image: the noise of its masks, the stretch and size of its caps."""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum, sqrt

import numpy as np

from fairyring.model.contour.contact import Contact
from fairyring.model.contour.harmonic import Array, Estimate, coverage_of
from fairyring.model.contour.noise import deviation, expected_power, power
from fairyring.model.contour.priors import Priors
from fairyring.model.contour.rims import Rims

USUAL_NOISE = 0.5
"""Standard deviation of a rim point before it is measured, pixels."""
USUAL_CAPS = 4
"""How many caps the usual stretch weighs as much as."""
SHARP_STRETCH = 0.02
"""A cap's stretch is known well if its standard deviation is less than this."""
WIDEST_STRETCH = 0.3
"""A cap counts as no more stretched than this: it may be mislabelled."""
IN_VIEW = 0.6
"""The sizes of caps with so much of their rim in sight are known …"""
LEAST_CAPS = 8
"""… and tell what size to expect of others if there are so many …"""
LEAST_SPREAD = 0.2
"""… which are never taken to be more alike than this, standard deviation of log r."""


@dataclass(frozen=True, slots=True)
class Statistics:
    """The statistics of an image."""

    noise: float
    """Standard deviation of a rim point, pixels."""
    power: float
    """Power of the noise along a rim, px³."""
    stretch: float
    """Standard deviation of each of the two components of a cap's stretch."""
    size: float = 0.0
    """Median log r of the caps."""
    size_precision: float = 0.0
    """One over the variance of log r, 0 where sizes are not known."""


def usual_statistics(priors: Priors) -> Statistics:
    """What is expected of an image before its own statistics are known."""
    return Statistics(
        noise=USUAL_NOISE,
        power=expected_power(USUAL_NOISE, priors),
        stretch=priors.stretch * priors.stretch_hidden,
    )


def measured_statistics(
    rims: Rims, contact: Contact, estimate: Estimate, own: Array, priors: Priors
) -> Statistics:
    """The statistics of an image of n ≥ 1 caps, the same in whatever order these come.

    ``own`` (n, K) is how probable it is that a rim point lies on the cap's own rim.
    """
    noise = deviation(estimate, contact, priors)
    size, size_precision = _sizes(estimate.outlines.log_radius[coverage_of(rims, estimate, own) >= IN_VIEW])
    return Statistics(
        noise=noise,
        power=power(rims, estimate, own, priors, noise=noise),
        stretch=_stretch(estimate, priors),
        size=size,
        size_precision=size_precision,
    )


def _sizes(log_radius: Array) -> tuple[float, float]:
    """Median and precision of the log r (m,) of caps in view; of too few, nothing is known."""
    if len(log_radius) < LEAST_CAPS:
        return 0.0, 0.0
    median = float(np.median(log_radius))
    variance = fsum(((log_radius - median) ** 2).tolist()) / len(log_radius)
    return median, 1 / max(variance, LEAST_SPREAD**2)


def _stretch(estimate: Estimate, priors: Priors) -> float:
    """How far from round the caps are, judged by those of which it is known, and by what is usual."""
    variance = (estimate.covariance[:, 3, 3] + estimate.covariance[:, 4, 4]) / 2
    trust = 1 / (1 + variance / SHARP_STRETCH**2)
    square = (estimate.outlines.shape[:, :2] ** 2).sum(axis=1) / 2 + variance
    # Sums without rounding, for they must not depend on the order.
    weighted = fsum((trust * square.clip(max=WIDEST_STRETCH**2)).tolist()) + USUAL_CAPS * priors.stretch**2
    return sqrt(weighted / (fsum(trust.tolist()) + USUAL_CAPS))
