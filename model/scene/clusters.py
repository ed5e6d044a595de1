"""Flat clusters of caps whose whole outlines are known: what contour methods are measured on.

The recipe: caps of 30 to 150 px across lie in clumps on each other, close to half of them partly hidden, and
a sixth of them by more than 40 %. A whole outline is an ellipse with a little of the next three harmonics;
its centre is that of the ellipse. What is seen of it is a mask, whose outline wanders by so many pixels,
correlated over about 8 px, as the outlines that a network or a hand draws do.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.silhouette import RIM_INSET
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import (
    Ellipse,
    Points,
    canonical_ellipse,
    centres_of_pixels,
    part_of_points,
    signed_area,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Recipe:
    """How caps look and lie. Lengths in pixels, shape deviations relative to the radius."""

    width: int = 1280
    height: int = 720
    count: int = 55
    radius: tuple[float, float, float] = (15.0, 38.0, 75.0)
    """Least, typical and largest."""
    stretch: float = 0.034
    """Standard deviation of each of the two components of the second harmonic."""
    wobble: tuple[float, ...] = (0.0085, 0.006, 0.0042)
    """The same of the third harmonic and the next ones."""
    closeness: tuple[float, float] = (0.7, 1.15)
    """Distance of a cap to one it lies against, over the sum of their radii."""
    company: float = 0.35
    """Share of caps that lie against another one."""
    least_visible: float = 0.12
    margin: float = 0.8
    """How far inside the image's border a centre stays, in radii; below 1, caps are cut."""
    noise: float = 0.0
    """Standard deviation of a mask's outline."""
    correlation: float = 4.8
    """Standard deviation of the Gaussian that smooths that noise along the outline."""


@dataclass(frozen=True, slots=True)
class ClusterCap:
    """One cap of a cluster, and what a method may see of it."""

    mask: NDArray[np.uint8]
    """What is seen, cropped: (h, w), 1 inside."""
    left: int
    top: int
    whole: Ellipse
    outline: Points
    """The true whole outline, (n, 2)."""
    visible_fraction: float
    """Of the whole outline's area, before noise and with the image's border taken as an occluder."""


@dataclass(frozen=True, slots=True)
class Cluster:
    """An image's caps, back to front."""

    width: int
    height: int
    caps: list[ClusterCap] = field(repr=False)


COARSE = 4


@dataclass(frozen=True, slots=True)
class _Cap:
    whole: Ellipse
    outline: Points
    coarse: NDArray[np.bool_]
    """Its mask on a grid of `COARSE` pixels, which is enough to decide where it may lie."""


def make_cluster(*, seed: int, recipe: Recipe | None = None) -> Cluster:
    """A cluster by the recipe; the same seed gives the same one. Caps with nothing in sight are left out."""
    recipe = recipe or Recipe()
    rng = np.random.default_rng(seed)
    lying = _lay(recipe, rng)
    masks = [_filled([cap.outline], width=recipe.width, height=recipe.height) for cap in lying]
    caps = []
    for cap, visible in zip(lying, _seen(masks), strict=True):
        noisy = _disturbed(visible, recipe, rng) if recipe.noise > 0 else visible.astype(np.uint8)
        if not noisy.any():
            continue
        left, top, width, height = cv2.boundingRect(noisy)
        crop = np.ascontiguousarray(noisy[top : top + height, left : left + width])
        share = float(visible.sum() / abs(signed_area(cap.outline)))
        caps.append(ClusterCap(crop, left, top, cap.whole, cap.outline, share))
    return Cluster(recipe.width, recipe.height, caps)


def _lay(recipe: Recipe, rng: np.random.Generator) -> list[_Cap]:
    """Puts caps down one on another, each new one refused if it would hide or be hidden too much."""
    caps: list[_Cap] = []
    for _ in range(recipe.count * 30):
        if len(caps) == recipe.count:
            break
        candidate = _cap(_place(caps, recipe, rng), recipe, rng)
        # A new cap goes to any height, so that small ones lie on large ones and under them.
        level = int(rng.integers(0, len(caps) + 1))
        proposed = [*caps[:level], candidate, *caps[level:]]
        shares = zip(_seen([cap.coarse for cap in proposed]), proposed, strict=True)
        if all(v.sum() >= recipe.least_visible * cap.coarse.sum() for v, cap in shares):
            caps = proposed
    return caps


def _place(caps: list[_Cap], recipe: Recipe, rng: np.random.Generator) -> tuple[float, float, float]:
    """A centre and a radius, against another cap or anywhere."""
    low, typical, high = recipe.radius
    r = float(rng.triangular(low, typical, high))
    inset = recipe.margin * r
    x, y = rng.uniform(inset, recipe.width - inset), rng.uniform(inset, recipe.height - inset)
    if caps and rng.random() < recipe.company:
        other = caps[rng.integers(len(caps))].whole
        angle = rng.uniform(0, 2 * np.pi)
        away = rng.uniform(*recipe.closeness) * (r + np.sqrt(other.a * other.b))
        x, y = other.cx + away * np.cos(angle), other.cy + away * np.sin(angle)
        x, y = np.clip(x, inset, recipe.width - inset), np.clip(y, inset, recipe.height - inset)
    return float(x), float(y), r


def _cap(place: tuple[float, float, float], recipe: Recipe, rng: np.random.Generator) -> _Cap:
    x, y, r = place
    u, v = rng.normal(0, recipe.stretch, 2)
    stretch, turn = np.hypot(u, v), np.arctan2(v, u) / 2
    whole = canonical_ellipse(x, y, r * np.exp(stretch), r * np.exp(-stretch), float(np.degrees(turn)))
    angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
    # The polar radius of that ellipse, then the higher harmonics on top: they leave its centre where it is.
    rim = r / np.sqrt(np.cosh(2 * stretch) - np.sinh(2 * stretch) * np.cos(2 * (angle - turn)))
    for order, size in enumerate(recipe.wobble, start=3):
        a, b = rng.normal(0, size, 2)
        rim = rim * np.exp(a * np.cos(order * angle) + b * np.sin(order * angle))
    outline = np.column_stack([x + rim * np.cos(angle), y + rim * np.sin(angle)])
    coarse = _filled([outline / COARSE], width=recipe.width // COARSE, height=recipe.height // COARSE)
    return _Cap(whole, outline, coarse)


def _filled(parts: list[Points], *, width: int, height: int) -> NDArray[np.bool_]:
    return mask_of_outline([part_of_points(part) for part in parts], height=height, width=width).astype(bool)


def _seen(masks: list[NDArray[np.bool_]]) -> list[NDArray[np.bool_]]:
    """What is seen of each mask when later ones lie in front."""
    visible = []
    covered = np.zeros_like(masks[0])
    for mask in reversed(masks):
        visible.append(mask & ~covered)
        covered = covered | mask
    return visible[::-1]


def _disturbed(visible: NDArray[np.bool_], recipe: Recipe, rng: np.random.Generator) -> NDArray[np.uint8]:
    """The mask whose outline wanders along its normal by ``recipe.noise``."""
    found, _ = cv2.findContours(visible.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    parts = []
    for contour in found:
        points = centres_of_pixels(contour)
        if len(points) < 8:
            continue
        smooth = _along(points, 2.0)
        tangent = np.roll(smooth, -2, axis=0) - np.roll(smooth, 2, axis=0)
        outward = np.column_stack([tangent[:, 1], -tangent[:, 0]]) * np.sign(signed_area(points) or 1)
        outward /= np.maximum(np.hypot(*outward.T), 1e-9)[:, None]
        wander = _along(rng.normal(0, 1, (len(points), 1)), recipe.correlation)
        wander *= np.sqrt(2 * np.sqrt(np.pi) * recipe.correlation)
        parts.append(smooth + (RIM_INSET + recipe.noise * wander) * outward)
    height, width = visible.shape
    return _filled(parts, width=width, height=height).astype(np.uint8)


def _along(values: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """A closed curve (n, k) smoothed by a Gaussian of so many points."""
    frequency = np.fft.rfftfreq(len(values))
    kernel = np.exp(-2 * (np.pi * frequency * sigma) ** 2)
    return np.fft.irfft(np.fft.rfft(values, axis=0) * kernel[:, None], n=len(values), axis=0)
