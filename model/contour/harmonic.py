"""Robust maximum-a-posteriori outlines, all caps of an image in one go.

An outline is an ellipse, r·expm([[u, v], [v, −u]]) around a centre, times the exponential of some harmonics
of the polar angle from the third on. The harmonics soak up the shape that a real cap has beyond an
ellipse, so that half a rim does not pass that off as a shift of the centre; on a whole rim they leave the
centre alone.

Legend: n caps, K rim points, H = 2 + 2·harmonics shape parameters, D = 3 + H parameters
(Δx/r, Δy/r, log r, u, v, a₃, b₃, …).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.expectation import Expected, corner_information, reach_of, roundness
from fairyring.model.contour.priors import Priors
from fairyring.model.contour.rims import Rims

Array = NDArray[np.floating]

CUT = 3.0
"""Residuals beyond so many standard deviations hardly count (Geman and McClure's weight)."""
LARGEST_MOVE = 0.25
"""Of the radius, in one step."""
LARGEST_GROWTH = 0.2
"""Of log r, in one step."""
LARGEST_CHANGE = 0.1
"""Of a shape parameter, in one step."""

_ORDERS = np.stack([np.ones(16), -np.arange(2, 18)])
"""What to multiply the second harmonic and the next by for the level and for minus its slope."""


@dataclass(frozen=True, slots=True)
class Outlines:
    """n whole outlines."""

    centre: Array
    """(n, 2)"""
    log_radius: Array
    """(n,)"""
    shape: Array
    """(n, H): u, v, a₃, b₃, …"""


@dataclass(frozen=True, slots=True)
class Evidence:
    """What n caps are fitted to."""

    points: Array
    """(n, K, 2)"""
    weight: Array
    """(n, K), information of a point, 1/px²."""
    seen: Array
    """(n, K), how probable it is that a point lies on the cap's own rim; else the cap goes on beyond it."""
    noise: float
    """Standard deviation of a point, pixels."""
    corner: Array
    """(n, K), how far it counts that a point is a corner of the hull of what is visible, 0 to 1."""
    reach: Array
    """(n,), what the logarithm of the longest radius is expected to be."""
    stretch: float
    """How far u and v are expected to be from 0."""
    size: float
    """What log r of any cap of the image is expected to be."""
    size_precision: float
    """One over the variance of that, 0 where it is not known."""
    expected: Expected
    """Where the caps are expected to lie."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """Outlines and how well they are known."""

    outlines: Outlines
    residual: Array
    """(n, K), how far a point lies outside the outline, pixels."""
    covariance: Array
    """(n, D, D), of the parameters."""
    doubt: Array
    """(n, K), variance of the outline itself at a point, px²."""


def fit_outlines(
    evidence: Evidence, start: Outlines, priors: Priors, *, softness: Sequence[float]
) -> Estimate:
    """Damped Gauss–Newton on the posterior, one step for each of the m ≥ 1 figures in ``softness``.

    ``softness`` multiplies the distance at which points stop to count: large figures first find the right
    valley.
    """
    for soft in softness[:-1]:
        start = _advance(start, evidence, priors, soft).outlines
    last = _advance(start, evidence, priors, softness[-1])
    covariance: Array = np.linalg.inv(last.curvature)
    doubt: Array = ((covariance @ last.slope) * last.slope).sum(axis=1)
    return Estimate(last.outlines, last.residual, covariance, doubt)


def coverage_of(rims: Rims, estimate: Estimate, own: Array) -> Array:
    """(n,), the share of the whole rim that is in sight.

    ``own`` (n, K) is how probable it is that a rim point lies on the cap's own rim.
    """
    around = 2 * np.pi * np.exp(estimate.outlines.log_radius)
    return np.clip((own * rims.spacing).sum(axis=1) / around, 0, 1)


@dataclass(frozen=True, slots=True)
class _Step:
    outlines: Outlines
    residual: Array
    """(n, K), after the step, to first order."""
    slope: Array
    """(n, D, K)"""
    curvature: Array
    """(n, D, D), of minus the log posterior."""


def _advance(now: Outlines, evidence: Evidence, priors: Priors, soft: float) -> _Step:
    residual, slope = _linearised(evidence.points, now)
    weighted = slope * _weights(residual, now, evidence, soft)[:, None]
    curvature = weighted @ slope.transpose(0, 2, 1)
    pull = (weighted @ residual[..., None])[..., 0]
    precision = _prior_precision(now, evidence, priors)
    diagonal = np.arange(curvature.shape[1])
    curvature[:, diagonal, diagonal] += precision
    pull[:, 2] -= precision[:, 2] * (now.log_radius - evidence.size)
    pull[:, 3:] -= precision[:, 3:] * now.shape
    reach = reach_of(now.log_radius, now.shape)
    information = reach.slope * priors.size**-2
    curvature[:, 2:5, 2:5] += information[:, :, None] * reach.slope[:, None]
    pull[:, 2:5] -= information * (reach.log_radius - evidence.reach)[:, None]
    curvature[:, :5, :5] += evidence.expected.precision
    pull[:, :5] += _towards(evidence.expected, now)
    moved, step = _moved(now, np.linalg.solve(curvature, pull[..., None])[..., 0])
    return _Step(moved, residual - (step[:, None] @ slope)[:, 0], slope, curvature)


def _towards(expected: Expected, now: Outlines) -> Array:
    """(n, 5), how strongly what is expected pulls at the centre, log r, u and v."""
    away = np.empty(expected.mean.shape)
    away[:, :2] = (expected.mean[:, :2] - now.centre) / np.exp(now.log_radius)[:, None]
    away[:, 2] = expected.mean[:, 2] - now.log_radius
    away[:, 3:] = expected.mean[:, 3:] - now.shape[:, :2]
    return (expected.precision @ away[..., None])[..., 0]


def _linearised(points: Array, outlines: Outlines) -> tuple[Array, Array]:
    """Residuals (n, K) and their slopes (n, D, K) by the parameters, both in pixels."""
    away = _complex(points - outlines.centre[:, None])[..., 0]
    distance = np.maximum(np.abs(away), 1e-6)
    toward = away / distance
    radius = np.exp(outlines.log_radius)[:, None]
    # With h = a + ib, conj(h) exp(ikφ) has the real part a cos kφ + b sin kφ, whose slope is −k × the other.
    weights = _complex(outlines.shape).conj()
    harmonics = _powers(toward, count=weights.shape[1])
    level, turning = (weights[:, None] * _ORDERS[:, : weights.shape[1]] @ harmonics).transpose(1, 0, 2)
    slope = np.empty((len(points), 3 + outlines.shape.shape[1], points.shape[1]))
    # Moving the centre shortens the distance and turns the point's polar angle.
    nearer = radius**2 / distance
    slope[:, 0] = (toward.real + toward.imag * turning.imag) * nearer
    slope[:, 1] = (toward.imag - toward.real * turning.imag) * nearer
    slope[:, 2] = radius
    np.multiply(harmonics.real, radius[..., None], out=slope[:, 3::2])
    np.multiply(harmonics.imag, radius[..., None], out=slope[:, 4::2])
    along = (weights[:, :1] * harmonics[:, 0]).real
    exact = level.real + _second_order(outlines.shape, along)
    return (np.log(distance) - outlines.log_radius[:, None] - exact) * radius, slope


def _complex(pairs: Array) -> NDArray[np.complexfloating]:
    """(…, 2m) as (…, m), x + iy."""
    return np.ascontiguousarray(pairs, np.float64).view(np.complex128)


def _powers(toward: NDArray[np.complexfloating], *, count: int) -> NDArray[np.complexfloating]:
    """The second power and the next, (n, count, K), of unit numbers (n, K)."""
    powers = np.empty((len(toward), count, toward.shape[1]), np.complex128)
    power = toward
    for index in range(count):
        power = np.multiply(power, toward, out=powers[:, index])
    return powers


def _second_order(shape: Array, along: Array) -> Array:
    """What the exact log polar radius of the ellipse has beyond u cos 2φ + v sin 2φ = ``along``, (n, K)."""
    size = np.sqrt(shape[:, 0] ** 2 + shape[:, 1] ** 2 + 1e-16)[:, None]
    return -0.5 * np.log(np.cosh(2 * size) - (np.sinh(2 * size) / size) * along) - along


def _weights(residual: Array, now: Outlines, evidence: Evidence, soft: float) -> Array:
    """How much each point pulls, (n, K).

    Hidden ones pull from outside, for the cap goes on beyond them; from inside only corners of the hull do,
    and little.
    """
    cut = CUT * soft * evidence.noise
    square = (residual / cut) ** 2
    on_rim = 1 / (1 + square) ** 2
    beyond = np.where(residual > 0, 1 / (1 + square / 4), 0)
    corners = evidence.corner * corner_information(residual, np.exp(now.log_radius))
    hidden = evidence.weight * beyond + corners
    return evidence.seen * evidence.weight * on_rim + (1 - evidence.seen) * hidden


def _prior_precision(now: Outlines, evidence: Evidence, priors: Priors) -> Array:
    """One over the prior variance of each parameter, (n, D)."""
    precision = np.empty((len(now.shape), 3 + now.shape.shape[1]))
    # Hardly any prior on where a cap lies: only so much that nothing is ever singular.
    precision[:, :2] = 1e-2
    precision[:, 2] = evidence.size_precision
    precision[:, 3:5] = roundness(now.shape, stretch=evidence.stretch)[:, None]
    precision[:, 5:] = np.repeat(np.asarray(priors.wobble) ** -2.0, 2)
    return precision


def _moved(now: Outlines, step: Array) -> tuple[Outlines, Array]:
    """The outlines one step (n, D) on, and that step cut to as far as they may go at once."""
    most = np.full(step.shape[1], LARGEST_CHANGE)
    most[2] = LARGEST_GROWTH
    most[:2] = np.inf
    step = np.minimum(np.maximum(step, -most), most)
    step[:, :2] /= np.maximum(np.hypot(step[:, 0], step[:, 1]) / LARGEST_MOVE, 1)[:, None]
    moved = Outlines(
        centre=now.centre + step[:, :2] * np.exp(now.log_radius)[:, None],
        log_radius=now.log_radius + step[:, 2],
        shape=now.shape + step[:, 3:],
    )
    return moved, step
