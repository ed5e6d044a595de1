"""How the rims of caps look where they lie on other caps: what an outline has to be found by.

Along every visible outline, each few pixels, the grey levels are read across it. Where another cap lies on
the far side, three figures say what is to be seen of the rim there.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Outline, Points, points_of_part, signed_area

Floats = NDArray[np.float64]

EVERY = 3.0
"""Distance of two profiles along an outline, px."""
REACH = 5
"""How far a profile goes to either side, px."""
BESIDE = slice(2, 5)
"""Distances from the rim that count as one side of it, px."""
FAR_SIDE = 3.0
"""Where the other cap must lie, px."""
PERCENT = (10, 25, 50, 75, 90)
FAINT_STEP, FAINT_DIP = 15.0, 10.0
"""A rim of less than both is faint."""


def rim_profiles(photo: NDArray[np.uint8], outlines: Sequence[Outline]) -> Floats:
    """(n, 2 * REACH + 1) grey levels across rims between two of the outlines, from inside to outside.

    ``photo`` is (height, width, 3). Outlines are of what is in sight, so they do not overlap. Rims near the
    photo's border are left out.
    """
    grey = photo.mean(axis=2).astype(np.float32)
    owners = np.zeros(grey.shape, np.int32)
    for number, outline in enumerate(outlines, start=1):
        owners[mask_of_outline(outline, height=grey.shape[0], width=grey.shape[1]) > 0] = number
    found = [np.empty((0, 2 * REACH + 1))]
    for number, outline in enumerate(outlines, start=1):
        for part in outline:
            places, outward = _along(points_of_part(part))
            inside = _owner(owners, places - FAR_SIDE * outward)
            outside = _owner(owners, places + FAR_SIDE * outward)
            shared = (inside == number) & (outside > 0) & (outside != number) & _within(places, grey.shape)
            found.append(_read(grey, places[shared], outward[shared]))
    return np.concatenate(found)


def rim_figures(profiles: Floats) -> dict[str, float]:
    """Quantiles over profiles of what ``rim_profiles`` returns, and the share of faint rims.

    Step: the difference of the two sides. Dip: how far the rim lies below the darker side. Steepest: the
    largest change from a pixel to the next. All in grey levels.
    """
    across = np.arange(-REACH, REACH + 1)
    inside = profiles[:, np.isin(-across, range(5)[BESIDE])].mean(axis=1)
    outside = profiles[:, np.isin(across, range(5)[BESIDE])].mean(axis=1)
    step = np.abs(inside - outside)
    dip = np.minimum(inside, outside) - profiles[:, np.abs(across) <= 1].min(axis=1)
    steepest = np.abs(np.diff(profiles, axis=1)).max(axis=1)
    figures = {
        f"rim {name} {percent} % (grey levels)": float(np.percentile(values, percent))
        for name, values in (("step", step), ("dip", dip), ("steepest", steepest))
        for percent in PERCENT
    }
    faint = (step < FAINT_STEP) & (dip < FAINT_DIP)
    return figures | {"faint rims": float(faint.mean())}


def _along(outline: Points) -> tuple[Points, Points]:
    """Places on a closed outline EVERY so many pixels, and unit vectors out of it there: (n, 2) each."""
    closed = np.vstack([outline, outline[:1]])
    run = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.arange(0.0, run[-1], EVERY)

    def place(where: Floats) -> Points:
        around = where % run[-1]
        return np.column_stack([np.interp(around, run, closed[:, axis]) for axis in (0, 1)])

    # Over as far as the next place, lest the steps of a pixelled outline turn it about.
    ahead = place(at + EVERY / 2) - place(at - EVERY / 2)
    outward = np.column_stack([ahead[:, 1], -ahead[:, 0]]) * np.sign(signed_area(outline) or 1.0)
    return place(at), outward / np.maximum(np.hypot(*outward.T), 1e-9)[:, None]


def _owner(owners: NDArray[np.int32], places: Points) -> NDArray[np.int32]:
    """Whose the pixels at places (n, 2) are; nobody's outside the photo."""
    column, row = np.floor(places).astype(np.intp).T
    height, width = owners.shape
    inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
    return np.where(inside, owners[row.clip(0, height - 1), column.clip(0, width - 1)], 0)


def _within(places: Points, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    height, width = shape
    x, y = places.T
    edge = REACH + 1
    return (x > edge) & (y > edge) & (x < width - edge) & (y < height - edge)


def _read(grey: NDArray[np.float32], places: Points, outward: Points) -> Floats:
    """Grey levels across outlines at places (n, 2), bilinear; the centre of pixel i is i + 0.5."""
    across = np.arange(-REACH, REACH + 1)
    at = (places[:, None] + across[None, :, None] * outward[:, None] - 0.5).astype(np.float32)
    if len(at) == 0:
        return np.empty((0, len(across)))
    # OpenCV takes pictures of fewer than 32768 rows.
    parts = [
        cv2.remap(grey, part[..., 0], part[..., 1], cv2.INTER_LINEAR)
        for part in np.array_split(at, -(-len(at) // 30000))
    ]
    return np.concatenate(parts).astype(np.float64)
