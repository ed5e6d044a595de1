"""How a bed grows: caps come up in clusters, rise on their stalks and push each other aside.

Bed coordinates: x and y in the plane of the soil, z up from it, in the pixels of ``settings.Growth``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.scene.settings import MOST_CAPS, Growth

Floats = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]
"""left, top, right, bottom on the bed."""

SETTLING_STEPS = 36
PULL = 0.03
"""Share of the way back to where its stalk would have it that a cap takes in a step."""
TRIALS = 5
"""Places every cap may come up in, of which it takes the roomiest."""
LATE = 0.5
"""How high a cap has risen that came up late, of what it would have by its size."""
UNDER = 0.8
"""Where it comes up, in radii of the cap above it."""
CLEARANCE = 0.045
"""Share of their distance by which hard caps stay apart where they meet: a slit, narrow and deep."""
STEEPEST = 1.6
"""Slope of the most tilted cap: 58 degrees."""
FLATNESS = 0.75
"""A cap is lower than it is wide, so two meet above each other sooner than their radii say."""


class Stand(NamedTuple):
    """The n caps of a bed as grown."""

    radius: Floats
    """(n,)"""
    foot: Floats
    """(n, 2): where the stalk leaves the soil."""
    place: Floats
    """(n, 3): the middle of the cap, in the plane of its rim."""
    axis: Floats
    """(n, 3): unit vectors out of the tops of the caps."""


class Pairs(NamedTuple):
    """Caps that may touch, by index: (p,) each."""

    first: NDArray[np.intp]
    second: NDArray[np.intp]


def grow(growth: Growth, *, count: int, ground: Rectangle, rng: np.random.Generator) -> Stand:
    """``count`` caps come up on a rectangle of soil and settle until side by side they hardly overlap."""
    radius = _draw_diameters(growth, count, rng) / 2
    late = rng.random(count) < growth.tucked
    foot = _sprout(growth, radius, late, ground, rng)
    # In units of the radius: the large ones have grown over their neighbours.
    rise = radius * np.maximum(growth.height + growth.height_spread * rng.standard_normal(count), 0.3)
    rise = np.where(late, LATE * rise, rise)
    lean = np.tan(np.radians(np.clip(growth.lean_deg * rng.standard_normal((count, 2)), -55, 55)))
    wanted = np.column_stack([foot + lean * rise[:, None], rise])
    place = _settle(wanted, radius, give=0.2 * growth.squeeze - CLEARANCE)
    # A cap faces half where it grew to and half where its neighbours left its stalk to point.
    slope = 0.5 * lean + 0.5 * (place[:, :2] - foot) / place[:, 2:]
    slope *= np.minimum(1, STEEPEST / np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9))
    axis = np.column_stack([slope, np.ones(count)])
    return Stand(radius, foot, place, axis / np.linalg.norm(axis, axis=1, keepdims=True))


def zoomed(growth: Growth, zoom: float) -> Growth:
    """The same bed seen ``zoom`` times as large: as much of the picture is covered by fewer caps."""
    least, most = (min(max(round(count / zoom**2), 1), MOST_CAPS) for count in growth.caps)
    d0, d10, d50, d90, d100 = (zoom * diameter for diameter in growth.diameters)
    return replace(growth, caps=(least, most), diameters=(d0, d10, d50, d90, d100))


def pairs_within(centre: Floats, reach: Floats) -> Pairs:
    """Pairs of points (n, 2) closer than the sum of their reaches (n,)."""
    apart = np.linalg.norm(centre[:, None] - centre[None], axis=2)
    first, second = np.nonzero(np.triu(apart < reach[:, None] + reach[None], k=1))
    return Pairs(first, second)


def _draw_diameters(growth: Growth, count: int, rng: np.random.Generator) -> Floats:
    logs = np.log(growth.diameters)
    return np.exp(np.interp(rng.random(count), (0.0, 0.1, 0.5, 0.9, 1.0), logs))


def _sprout(
    growth: Growth,
    radius: Floats,
    late: NDArray[np.bool_],
    ground: Rectangle,
    rng: np.random.Generator,
) -> Floats:
    """(n, 2) feet: each cap comes up beside an earlier one of its cluster, where there is most room.

    Those that are ``late`` come up under the rim of one that has grown already.
    """
    left, top, right, bottom = ground
    count = len(radius)
    foot = np.zeros((count, 2))
    founder = 0
    while founder < count:
        end = min(founder + int(rng.geometric(1 / growth.cluster)), count)
        for cap in range(founder, end):
            if cap == founder:
                trials = rng.uniform((left, top), (right, bottom), (2, 2))
            else:
                parent = rng.integers(founder, cap, TRIALS)
                angle = rng.uniform(0, 2 * np.pi, TRIALS)
                beside = growth.spread * (radius[cap] + radius[parent])
                apart = np.where(late[cap], UNDER * radius[parent], beside) * rng.uniform(0.75, 1.25, TRIALS)
                trials = foot[parent] + apart[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
            foot[cap] = _roomiest(_kept_inside(trials, ground), foot[:cap], radius[:cap])
        founder = end
    return foot


def _kept_inside(points: Floats, ground: Rectangle) -> Floats:
    """Points (n, 2) outside the rectangle mirrored at its border."""
    least, most = np.array(ground[:2]), np.array(ground[2:])
    mirrored = np.where(points < least, 2 * least - points, points)
    return np.where(mirrored > most, 2 * most - mirrored, mirrored)


def _roomiest(trials: Floats, foot: Floats, radius: Floats) -> Floats:
    """The trial furthest from the nearest cap that stands already."""
    if len(foot) == 0:
        return trials[0]
    room = np.linalg.norm(trials[:, None] - foot[None], axis=2) - radius
    return trials[room.min(axis=1).argmax()]


def _settle(wanted: Floats, radius: Floats, *, give: float) -> Floats:
    """(n, 3): pushes caps that run into each other apart while their stalks pull them back.

    ``give`` is the share of two caps' distance by which they may run into each other;
    below 0 they stay apart.
    """
    place = wanted.copy()
    stretch = np.array([1.0, 1.0, 1.0 / FLATNESS])
    first, second = pairs_within(place[:, :2], 1.5 * radius)
    for _ in range(SETTLING_STEPS):
        between = (place[second] - place[first]) * stretch
        distance = np.maximum(np.linalg.norm(between, axis=1), 1e-6)
        excess = np.maximum((radius[first] + radius[second]) * (1 - give) - distance, 0)
        push = 0.4 * excess[:, None] * between / distance[:, None] / stretch
        share = (radius[second] ** 2 / (radius[first] ** 2 + radius[second] ** 2))[:, None]
        place -= _summed(first, push * share, len(place))
        place += _summed(second, push * (1 - share), len(place))
        place += PULL * (wanted - place)
        place[:, 2] = np.maximum(place[:, 2], 0.25 * radius)
    return place


def _summed(index: NDArray[np.intp], vectors: Floats, count: int) -> Floats:
    sums = [np.bincount(index, vectors[:, axis], count) for axis in range(vectors.shape[1])]
    return np.column_stack(sums).astype(np.float64)
