"""Who lies in front where two caps meet, and an overlap order for the image.

A border shared by caps i and j is the rim of i, of j, or, where they merely touch, of both. How well the
outlines of the two, as far as they are known already, run through the border says which.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.contact import Contact
from fairyring.model.contour.harmonic import Estimate
from fairyring.model.contour.rims import Rims

INDEPENDENT = 12.0
"""Length of outline per independent sample, pixels."""
LEAST_NOISE = 0.5
"""Borders between masks are never better known than this, pixels."""
SPAN = 0.5
"""A hidden rim lies anywhere within so many radii beyond the border."""
TOUCH = 0.2
"""How probable it is, over one cap lying in front, that two only touch: they seldom do along a border."""
WORST = 16.0
"""A squared residual in units of its variance counts no more than this."""


@dataclass(frozen=True, slots=True)
class Meetings:
    """The m pairs of caps that meet."""

    pairs: NDArray[np.int_]
    """(m, 2), indices i < j."""
    rim: NDArray[np.float64]
    """(m, 2), how probable it is that their border is the rim of i, and of j."""
    front: NDArray[np.float64]
    """(m,), how probable it is that i lies in front of j, if one of them does."""
    of_point: NDArray[np.int_]
    """(n, K), the pair met at a point, −1 where there is none."""


def meetings_of(contact: Contact, rims: Rims, estimate: Estimate, *, noise: float) -> Meetings:
    """Weighs the three readings of every shared border by the residuals of both caps along it."""
    cap, point = np.nonzero(contact.neighbour >= 0)
    other = contact.neighbour[cap, point]
    of_point = np.full(contact.neighbour.shape, -1)
    if len(cap) == 0:
        return Meetings(np.zeros((0, 2), np.int64), np.zeros((0, 2)), np.zeros(0), of_point)
    key = np.minimum(cap, other) * len(rims.points) + np.maximum(cap, other)
    keys, pair = np.unique(key, return_inverse=True)
    of_point[cap, point] = pair
    samples = rims.spacing[cap, point] / INDEPENDENT
    residual = estimate.residual[cap, point]
    variance = max(noise, LEAST_NOISE) ** 2 + estimate.doubt[cap, point]
    misfit = -0.5 * np.minimum(residual**2 / variance, WORST)
    as_rim = misfit - 0.5 * np.log(2 * np.pi * variance)
    as_cover = np.where(residual < 0, 0, misfit) - np.log(SPAN) - estimate.outlines.log_radius[cap]
    side = 2 * pair + (cap > other)
    rim, cover = (
        np.bincount(side, score * samples, minlength=2 * len(keys)).reshape(-1, 2)
        for score in (as_rim, as_cover)
    )
    before, behind, beside = (
        rim[:, 0] + cover[:, 1],
        cover[:, 0] + rim[:, 1],
        rim[:, 0] + rim[:, 1] + np.log(TOUCH),
    )
    most = np.maximum(np.maximum(before, behind), beside)
    before, behind, beside = (np.exp(score - most) for score in (before, behind, beside))
    rims_of_both = np.column_stack([before + beside, behind + beside]) / (before + behind + beside)[:, None]
    # Where they most likely only touch, both other readings are too small to compare as they are.
    front = 1 / (1 + np.exp(np.clip(cover[:, 0] + rim[:, 1] - rim[:, 0] - cover[:, 1], -50, 50)))
    return Meetings(np.column_stack(np.divmod(keys, len(rims.points))), rims_of_both, front, of_point)


def seen_share(contact: Contact, meetings: Meetings) -> NDArray[np.float64]:
    """(n, K), how probable it is that a rim point lies on the cap's own rim."""
    seen = contact.free.astype(np.float64)
    cap, point = np.nonzero(meetings.of_point >= 0)
    second = cap > contact.neighbour[cap, point]
    seen[cap, point] = meetings.rim[meetings.of_point[cap, point], second.astype(np.int64)]
    return seen


def overlap_order(meetings: Meetings, *, caps: int) -> tuple[NDArray[np.int_], NDArray[np.float64]]:
    """Ranks (n,), 0 the rearmost, and the confidence (n,) of the least certain decision about each cap.

    Decisions are taken in from the surest on, and one that would close a cycle with surer ones
    is turned round. A cap that meets nobody is certain.
    """
    above: list[set[int]] = [set() for _ in range(caps)]
    sureness = np.abs(meetings.front - 0.5)
    confidence = np.ones(caps)
    for at in np.argsort(-sureness, kind="stable"):
        i, j = meetings.pairs[at].tolist()
        front, back = (i, j) if meetings.front[at] >= 0.5 else (j, i)
        sure = 0.5 + float(sureness[at])
        if _reaches(above, front, back):
            front, back, sure = back, front, 0.5
        above[back].add(front)
        confidence[[i, j]] = np.minimum(confidence[[i, j]], sure)
    return _ranks(above), confidence


def _reaches(above: list[set[int]], start: int, goal: int) -> bool:
    """Whether ``goal`` is known to lie in front of ``start``."""
    open_, known = [start], {start}
    while open_:
        for cap in above[open_.pop()] - known:
            if cap == goal:
                return True
            known.add(cap)
            open_.append(cap)
    return False


def _ranks(above: list[set[int]]) -> NDArray[np.int_]:
    """How many caps lie under each in the longest chain."""
    under = [0] * len(above)
    for back in range(len(above)):
        for front in above[back]:
            under[front] += 1
    ready = [cap for cap, count in enumerate(under) if count == 0]
    rank = np.zeros(len(above), np.int_)
    while ready:
        back = ready.pop()
        for front in above[back]:
            rank[front] = max(rank[front], rank[back] + 1)
            under[front] -= 1
            if under[front] == 0:
                ready.append(front)
    return rank
