"""Where the caps of an image lie, and who touches whom; kept up to date as caps come and go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.batch import joined, single_caps
from fairyring.model.contour.contact import ELSEWHERE, NOBODY, REACH, Contact, contact_of
from fairyring.model.contour.rims import Rims, rims_of
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.geometry.boxes import touching

NEAR = REACH[-1] + 2
"""Silhouettes whose boxes are further apart than this do not touch, pixels."""


@dataclass(frozen=True, slots=True)
class Touch:
    """What one cap touches."""

    contact: Contact
    """Contact of this one cap; neighbours by their number in ``others``."""
    others: Mapping[Silhouette, int]
    """The caps it touches, with their numbers, in order."""


@dataclass(frozen=True)
class Layout:
    """The caps of an image, each with something to see."""

    width: int
    height: int
    caps: Sequence[Silhouette]
    """The caps, all different."""
    boxes: NDArray[np.int_]
    """(n, 4), left, top, right, bottom."""
    rims: Mapping[Silhouette, Rims]
    """The rim of every cap."""
    touches: Mapping[Silhouette, Touch]

    def near(self, *caps: Silhouette) -> list[Silhouette]:
        """The caps that might touch any of these, of which there is one or more; these among them."""
        left, top, right, bottom = zip(*(cap.box for cap in caps), strict=True)
        around = np.array([[min(left) - NEAR, min(top) - NEAR, max(right) + NEAR, max(bottom) + NEAR]])
        return [self.caps[at] for at in np.flatnonzero(touching(around, self.boxes)).tolist()]

    def neighbours(self, cap: Silhouette) -> set[Silhouette]:
        """The caps whose borders with this one are decided on together with its own."""
        return self._touched_by[cap].union(self.touches[cap].others)

    @cached_property
    def _touched_by(self) -> Mapping[Silhouette, set[Silhouette]]:
        found: dict[Silhouette, set[Silhouette]] = {cap: set() for cap in self.caps}
        for cap, touch in self.touches.items():
            for other in touch.others:
                found[other].add(cap)
        return found

    def batch(self, caps: Sequence[Silhouette]) -> tuple[Rims, Contact]:
        """The rims of these n ≥ 1 caps, and their contact with each other, neighbours by index among them."""
        index = {cap: at for at, cap in enumerate(caps)}
        contacts = [_indexed(self.touches[cap], index) for cap in caps]
        return joined([self.rims[cap] for cap in caps]), joined(contacts)


def empty_layout(*, width: int, height: int) -> Layout:
    """The layout of an image of this size without caps."""
    return Layout(width, height, (), np.zeros((0, 4), np.int64), {}, {})


def changed_layout(
    layout: Layout, *, added: Sequence[Silhouette], removed: Iterable[Silhouette]
) -> tuple[Layout, set[Silhouette]]:
    """The layout with some caps more and others less, and the caps of it that touch something else now.

    ``removed`` must be in the layout, ``added`` not, and hold n ≥ 0 different caps with something to see.
    """
    gone = set(removed)
    stay = [cap not in gone for cap in layout.caps]
    caps = [*compress(layout.caps, stay), *added]
    boxes = np.array([cap.box for cap in added], np.int64).reshape(-1, 4)
    rims, touches = dict(layout.rims), dict(layout.touches)
    for cap in gone:
        del rims[cap], touches[cap]
    if added:
        rims |= zip(added, single_caps(rims_of(added), caps=len(added)), strict=True)
    new = replace(layout, caps=caps, boxes=np.concatenate([layout.boxes[stay], boxes]), rims=rims)
    around = {cap for change in (*added, *gone) for cap in new.near(change)}
    fresh = _touches(new, list(around)) if around else {}
    differ = {cap for cap, touch in fresh.items() if not _same(touch, layout.touches.get(cap))}
    return replace(new, touches=touches | fresh), differ


def _touches(layout: Layout, caps: Sequence[Silhouette]) -> dict[Silhouette, Touch]:
    in_sight = [*caps, *set(layout.near(*caps)).difference(caps)]
    rims = joined([layout.rims[cap] for cap in caps])
    contact = contact_of(rims, in_sight, width=layout.width, height=layout.height)
    contacts = single_caps(contact, caps=len(caps))
    return {cap: _touch(one, in_sight) for cap, one in zip(caps, contacts, strict=True)}


def _touch(contact: Contact, in_sight: Sequence[Silhouette]) -> Touch:
    found = sorted({index for index in contact.neighbour.ravel().tolist() if index >= 0})
    if not found:
        return Touch(contact, {})
    own_index = np.full(len(in_sight) + 1, NOBODY)
    own_index[found] = np.arange(len(found))
    others = {in_sight[index]: own for own, index in enumerate(found)}
    return Touch(Contact(own_index[contact.neighbour], contact.border), others)


def _indexed(touch: Touch, index: Mapping[Silhouette, int]) -> Contact:
    """The contact with neighbours named by this index, those without one as `ELSEWHERE`."""
    if not touch.others:
        return touch.contact
    renamed = np.array([*(index.get(other, ELSEWHERE) for other in touch.others), NOBODY])
    return Contact(renamed[touch.contact.neighbour], touch.contact.border)


def _same(touch: Touch, before: Touch | None) -> bool:
    """Whether every point touches what it touched before."""
    if before is None:
        return False
    who, who_before = (np.array([*each.others, None], object) for each in (touch, before))
    now, then = who[touch.contact.neighbour], who_before[before.contact.neighbour]
    return bool((now == then).all() and (touch.contact.border == before.contact.border).all())
