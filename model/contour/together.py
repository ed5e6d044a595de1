"""The `map` method: all caps of an image together.

First every cap is fitted to what is surely its own rim; then each border between two caps is given to the
one in front, or to both where they only touch, and all are fitted again. How noisy the masks are, and how far
from round the caps, is measured on the way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from fairyring.model.contour.contact import Contact, contact_of
from fairyring.model.contour.harmonic import Array, Evidence, Fit, Outlines, fit_outlines
from fairyring.model.contour.noise import FIRST_NOISE, LEAST_NOISE, deviation, expected_power, power
from fairyring.model.contour.order import Meetings, meetings_of, seen_share
from fairyring.model.contour.priors import Priors
from fairyring.model.contour.rims import Rims, rims_of
from fairyring.model.contour.silhouette import Silhouette

FIRST_GLANCE = 0.3
"""How probable it is that a border is one's own rim, before anything is known."""
DECISIONS = 2
"""How often borders are decided on and caps fitted again."""
FIRST_SOFTNESS = (3.0, 2.0, 1.0, 1.0)
NEXT_SOFTNESS = (1.0, 1.0)
"""Steps of the first fit and of those after decisions on the borders."""
HIDDEN_DOUBT = 0.6
"""Standard deviations grow by this share for a rim that is all hidden: borders may have been misjudged."""


@dataclass(frozen=True, slots=True)
class Together:
    """n caps of an image, fitted."""

    rims: Rims
    contact: Contact
    meetings: Meetings
    evidence: Evidence
    fit: Fit
    around: Outlines
    """The circles around what is visible."""

    @property
    def coverage(self) -> Array:
        """(n,), the share of the whole rim that is in sight."""
        around = 2 * np.pi * np.exp(self.fit.outlines.log_radius)
        return np.clip((self.evidence.seen * self.rims.spacing).sum(axis=1) / around, 0, 1)

    @property
    def centre_sd(self) -> Array:
        """(n, 2), one standard deviation of the centre along x and y, pixels."""
        relative: Array = np.sqrt(self.fit.covariance[:, [0, 1], [0, 1]])
        radius = np.exp(self.fit.outlines.log_radius)
        return relative * (radius * (1 + HIDDEN_DOUBT * (1 - self.coverage)))[:, None]


def fit_together(caps: Sequence[Silhouette], priors: Priors, *, width: int, height: int) -> Together:
    """Fits n ≥ 1 silhouettes, each with something to see, of an image of this size."""
    rims = rims_of(caps)
    contact = contact_of(caps, rims, width=width, height=height)
    around = _enclosing(rims, priors)
    seen = np.where(contact.neighbour >= 0, FIRST_GLANCE, contact.free)
    evidence = Evidence(
        points=rims.points,
        weight=rims.spacing / expected_power(FIRST_NOISE, priors),
        seen=seen,
        noise=FIRST_NOISE,
        size=around.log_radius + priors.size_shift,
        stretch=priors.stretch * priors.stretch_hidden,
    )
    fit = fit_outlines(evidence, around, priors, softness=FIRST_SOFTNESS)
    for _ in range(DECISIONS):
        noise = deviation(fit, contact, priors, before=evidence.noise)
        meetings = meetings_of(contact, rims, fit, noise=noise)
        evidence = replace(
            evidence,
            weight=rims.spacing / power(rims, fit, evidence, priors, noise=noise),
            seen=seen_share(contact, meetings),
            noise=max(noise, LEAST_NOISE),
            stretch=_stretch(fit, priors) * priors.stretch_hidden,
        )
        fit = fit_outlines(evidence, fit.outlines, priors, softness=NEXT_SOFTNESS)
    return Together(
        rims, contact, meetings_of(contact, rims, fit, noise=evidence.noise), evidence, fit, around
    )


def _enclosing(rims: Rims, priors: Priors) -> Outlines:
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


def _stretch(fit: Fit, priors: Priors) -> float:
    """How far from round this image's caps are, judged by those whose u and v are known to 0.02 or so."""
    variance = (fit.covariance[:, 3, 3] + fit.covariance[:, 4, 4]) / 2
    trust = 1 / (1 + variance / 0.02**2)
    square = np.minimum((fit.outlines.shape[:, :2] ** 2).sum(axis=1) / 2 + variance, 0.3**2)
    prior_caps = 4
    return float(np.sqrt((trust @ square + prior_caps * priors.stretch**2) / (trust.sum() + prior_caps)))
