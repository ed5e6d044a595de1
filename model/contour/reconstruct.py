"""Whole outlines and centres of an image's caps from what is visible of them (section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fairyring.model.contour.methods import DEFAULT_METHOD, METHODS, Scene
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.geometry.shapes import Outline

__all__ = ["DEFAULT_METHOD", "METHODS", "Reconstruction", "reconstruct", "reconstruct_silhouettes"]

UNSEEN = Reconstruction(refusal="Nothing of this cap is visible inside the image.")
TOUCH = 6.0
"""Boxes nearer to each other than this may hold caps that touch, pixels."""
RINGS = 2
"""A cap is judged with its neighbours, whose borders are judged with theirs."""


def reconstruct(
    caps: Sequence[Outline],
    *,
    width: int,
    height: int,
    method: str | None = None,
    only: Sequence[int] | None = None,
    priors: Priors = DEFAULT,
) -> list[Reconstruction]:
    """The whole outlines of an image's caps, given the visible outlines of all of them.

    ``width`` and ``height`` are the image's. The caps that are not in ``only`` (indices; None: all) are
    context for the others; the answers come in the order of ``only``. ``method`` is one of `METHODS`, None
    the default; KeyError for any other. A cap that cannot be reconstructed is refused with a sentence, and
    its neighbours are not troubled by it.

    With ``only``, no more than the neighbours' neighbours are looked at, so that a live refit takes
    milliseconds; noise and roundness are then measured on these alone, and the answer differs from that of
    the whole image by a few hundredths of a pixel.
    """
    wanted = list(range(len(caps)) if only is None else only)
    near = _context(caps, wanted) if only is not None else wanted
    silhouettes = [silhouette_of_outline(caps[index], width=width, height=height) for index in near]
    place = {index: position for position, index in enumerate(near)}
    found = reconstruct_silhouettes(
        silhouettes,
        width=width,
        height=height,
        method=method,
        only=[place[index] for index in wanted],
        priors=priors,
    )
    return found if only is None else [_renumbered(each, near) for each in found]


def reconstruct_silhouettes(
    caps: Sequence[Silhouette],
    *,
    width: int,
    height: int,
    method: str | None = None,
    only: Sequence[int] | None = None,
    priors: Priors = DEFAULT,
) -> list[Reconstruction]:
    """As `reconstruct`, from masks, with all of them as context."""
    fit = METHODS[method or DEFAULT_METHOD]
    wanted = range(len(caps)) if only is None else only
    there = [index for index, cap in enumerate(caps) if cap.mask.any()]
    place = {index: position for position, index in enumerate(there)}
    asked = [place[index] for index in wanted if index in place]
    if not asked:
        return [UNSEEN for _ in wanted]
    scene = Scene(caps=[caps[index] for index in there], width=width, height=height, priors=priors)
    found = iter(fit(scene, asked))
    return [_renumbered(next(found), there) if index in place else UNSEEN for index in wanted]


def _context(caps: Sequence[Outline], wanted: Sequence[int]) -> list[int]:
    """The wanted caps, their neighbours and the neighbours of these, by their boxes."""
    boxes = np.array([_box(cap) for cap in caps]).reshape(-1, 4)
    near = np.zeros(len(caps), np.bool_)
    near[list(wanted)] = True
    for _ in range(RINGS):
        low, high = boxes[near, :2] - TOUCH, boxes[near, 2:] + TOUCH
        apart = (boxes[:, None, :2] > high).any(axis=-1) | (boxes[:, None, 2:] < low).any(axis=-1)
        near |= ~apart.all(axis=-1)
    return np.flatnonzero(near).tolist()


def _box(cap: Outline) -> tuple[float, float, float, float]:
    xs, ys = [x for part in cap for x in part[0::2]], [y for part in cap for y in part[1::2]]
    if not xs or not ys:
        return (np.inf, np.inf, -np.inf, -np.inf)
    return (min(xs), min(ys), max(xs), max(ys))


def _renumbered(found: Reconstruction, names: Sequence[int]) -> Reconstruction:
    """The same with neighbours named as the caller counts them."""
    if all(arc.neighbour is None or names[arc.neighbour] == arc.neighbour for arc in found.arcs):
        return found
    arcs = tuple(
        arc if arc.neighbour is None else replace(arc, neighbour=names[arc.neighbour]) for arc in found.arcs
    )
    return replace(found, arcs=arcs)
