"""The pieces of a visible outline, each tagged with what it is a piece of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.result import Arc, ArcKind
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.together import Together
from fairyring.model.geometry.told_arcs import NOT_TOLD, TOLD_KINDS

HOLLOW = 3.0
"""A free point lies in a hollow if it is so many standard deviations inside the outline …"""
LEAST_HOLLOW = 2.0
"""… and no less than this, pixels."""

_KINDS: tuple[ArcKind, ...] = (*TOLD_KINDS, "concave")


def kinds_of(together: Together) -> NDArray[np.int_]:
    """(n, K), what each rim point is, as people said, else as it was worked out: an index into ``_KINDS``."""
    contact = together.contact
    hollow = together.look.estimate.residual < -max(LEAST_HOLLOW, HOLLOW * together.statistics.noise)
    kinds = np.zeros(contact.neighbour.shape, np.int64)
    kinds[(contact.neighbour >= 0) & (together.look.own < 0.5)] = 1
    kinds[contact.border] = 2
    kinds[(kinds == 0) & hollow] = _KINDS.index("concave")
    told = together.rims.told
    return np.where(told == NOT_TOLD, kinds, told)


def arcs_of(together: Together, cap: int, kinds: NDArray[np.int_]) -> tuple[Arc, ...]:
    """The arcs of one cap in order along its outline, the first starting where the kind changes."""
    neighbour = np.where(kinds[cap] == 1, together.contact.neighbour[cap], -1)
    told = together.rims.told[cap] != NOT_TOLD
    key = (told + 2 * (kinds[cap] + len(_KINDS) * (neighbour + 1))).tolist()
    points = together.rims.points[cap]
    starts = [at for at in range(len(key)) if key[at] != key[at - 1]]
    if not starts:
        return (_arc(key[0], points, together.in_sight),)
    twice = np.concatenate([points, points])
    ends = [*starts[1:], starts[0] + len(key)]
    return tuple(
        _arc(key[start], twice[start:end], together.in_sight) for start, end in zip(starts, ends, strict=True)
    )


def _arc(key: int, points: NDArray[np.float64], in_sight: Sequence[Silhouette]) -> Arc:
    rest, told = divmod(key, 2)
    neighbour, kind = divmod(rest, len(_KINDS))
    in_front = in_sight[neighbour - 1] if neighbour else None
    return Arc(kind=_KINDS[kind], points=points, neighbour=in_front, told=bool(told))
