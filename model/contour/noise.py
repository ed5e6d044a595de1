"""How much the rims of an image's masks waver about their caps' true outlines, measured on the way.

Two figures matter: the standard deviation of a rim point, which says what an outlier is, and the power of the
wavering, which says how much a piece of rim is worth: variance × length of outline per independent sample.
Wavering that is smooth along the outline has few independent samples and so much power.
"""

from __future__ import annotations

from math import log

import numpy as np

from fairyring.model.contour.contact import Contact
from fairyring.model.contour.harmonic import Array, Estimate
from fairyring.model.contour.priors import Priors
from fairyring.model.contour.rims import BINS, Rims

FIRST_NOISE = 0.8
LEAST_NOISE = 0.25
"""Standard deviations of a rim point, pixels: before anything is known, and at least."""
USUAL_POINTS = 20
"""How many rim points the usual noise weighs as much as."""
PERFECT = 0.018
"""Variance of a rim point of a perfect mask, from the pixel grid alone, px²."""
PERFECT_RIPPLE = 0.08
"""Power of a perfect mask's ripples, from the pixel grid alone, px³."""
RIPPLES = (6, 7, 8)
"""Waves round a rim that no outline follows, yet so long that they tell how smooth the noise is."""
RIPPLE_GAIN = 1.9
"""Power of the few waves an outline does follow over that of the ripples: the smoother, the stronger."""
IN_VIEW = 0.9
"""A cap with so much of its rim in sight shows its ripples."""
USUAL_CAPS = 4
"""How many such caps the power expected of the noise weighs as much as."""

_WAVES = np.exp(2j * np.pi * np.outer(np.arange(BINS), RIPPLES) / BINS)


def deviation(estimate: Estimate, contact: Contact, priors: Priors) -> float:
    """The standard deviation of rim points: robust, and leaning on the usual one where there are few."""
    residual = estimate.residual[contact.free]
    if len(residual) == 0:
        return priors.noise
    robust = float(np.median(np.abs(residual))) / 0.6745
    weight = len(residual) + USUAL_POINTS
    return float(np.sqrt((robust**2 * len(residual) + USUAL_POINTS * priors.noise**2) / weight))


def expected_power(noise: float, priors: Priors) -> float:
    """The power of noise of this standard deviation, px³: small for a pixel grid's alone."""
    return priors.noise_floor + priors.noise_length * max(noise**2 - PERFECT, 0)


def power(rims: Rims, estimate: Estimate, own: Array, priors: Priors, *, noise: float) -> float:
    """The power of the noise, px³: from the ripples of the caps in view, else as is expected."""
    ripples = ripple_powers(rims, estimate, own)
    trust = len(ripples) / (len(ripples) + USUAL_CAPS)
    if trust == 0:
        return expected_power(noise, priors)
    # A power is spread exponentially, with the median ln 2 of its mean.
    beyond = max(float(np.median(ripples)) / log(2) - PERFECT_RIPPLE, 0)
    measured = priors.noise_floor + RIPPLE_GAIN * beyond
    return trust * measured + (1 - trust) * expected_power(noise, priors)


def ripple_powers(rims: Rims, estimate: Estimate, own: Array) -> Array:
    """(m, 3), the power of each of `RIPPLES` in the rims of the m caps in view, px³.

    ``own`` (n, K) is how probable it is that a rim point lies on the cap's own rim.
    """
    seen = own >= 0.5
    whole = seen.mean(axis=1) >= IN_VIEW
    # Cap by cap: one product of all would round by their order.
    waves = ((estimate.residual[whole] * seen[whole])[:, None] @ _WAVES)[:, 0]
    return np.abs(waves) ** 2 * (rims.spacing[whole].sum(axis=1) / BINS**2)[:, None]
