"""What lies on what: caps and stalks as layers, painted from the soil up to say whose each pixel is."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import bounds_of_outline
from fairyring.model.scene.caps import Box, Cap, Surface, polygon_of_cap, surface_of_cap
from fairyring.model.scene.stalks import Stalk, bounds_of_stalk, cover_of_stalk, surface_of_stalk

Owners = NDArray[np.int32]
"""(rows, columns): 0 soil, k + 1 the cap of mushroom k, -(k + 1) its stalk."""


STRIP_ROWS = 24
STALK_ORDER = 0.2
"""How far up a stalk the height lies that it is stacked by."""


class Layer(NamedTuple):
    """A cap or a stalk, cut to the picture."""

    mushroom: int
    is_cap: bool
    box: Box
    mask: NDArray[np.bool_]
    """Pixels of the box that are its own where nothing lies on it."""
    area: int
    """Pixels of all of it, outside the picture too."""
    order: float
    """View z it is stacked by."""

    @property
    def owner(self) -> int:
        """What it is called in Owners."""
        return self.mushroom + 1 if self.is_cap else -(self.mushroom + 1)


class Seen(NamedTuple):
    """What is in sight of a layer."""

    layer: Layer
    box: Box
    """Its pixels in sight and one more all round, where its edge is mixed with what lies under it."""
    surface: Surface
    """Over that box."""


def stack_layers(caps: list[Cap], stalks: list[Stalk], *, width: int, height: int) -> list[Layer]:
    """The layers with a pixel in the picture, from the lowest to the highest."""
    layers = [
        layer
        for index, (cap, stalk) in enumerate(zip(caps, stalks, strict=True))
        for layer in (_layer_of_cap(index, cap, width, height), _layer_of_stalk(index, stalk, width, height))
        if layer is not None
    ]
    return sorted(layers, key=lambda layer: (layer.order, layer.owner))


def own_pixels(layers: Iterable[Layer], *, width: int, height: int) -> Owners:
    """Whose each pixel is: the highest layer's that has it."""
    owners = np.zeros((height, width), np.int32)
    for layer in layers:
        np.copyto(owners[window(layer.box)], layer.owner, where=layer.mask)
    return owners


def look_at(layers: Iterable[Layer], owners: Owners, caps: list[Cap], stalks: list[Stalk]) -> list[Seen]:
    """The layers with a pixel in sight, from the lowest to the highest, with their surfaces there."""
    rows, columns = owners.shape
    seen = []
    for layer in layers:
        left, top, _, _ = layer.box
        own = owners[window(layer.box)] == layer.owner
        x, y, wide, high = cv2.boundingRect(own.view(np.uint8))
        if wide == 0:
            continue
        box = _cut((left + x - 1, top + y - 1, left + x + wide + 1, top + y + high + 1), columns, rows)
        if box:
            surface = (
                surface_of_cap(caps[layer.mushroom], box)
                if layer.is_cap
                else surface_of_stalk(stalks[layer.mushroom], box)
            )
            seen.append(Seen(layer, box, surface))
    return seen


def window(box: Box) -> tuple[slice, slice]:
    """A box as an index of an image."""
    left, top, right, bottom = box
    return slice(top, bottom), slice(left, right)


def strips(rows: int, columns: int) -> list[Box]:
    """Boxes that cover an image, few enough rows each that what is worked out there stays in the cache."""
    return [(0, top, columns, min(top + STRIP_ROWS, rows)) for top in range(0, rows, STRIP_ROWS)]


def _layer_of_cap(index: int, cap: Cap, width: int, height: int) -> Layer | None:
    polygon = polygon_of_cap(cap)
    x, y, wide, high = bounds_of_outline([polygon])
    around = (
        int(np.floor(x)) - 1,
        int(np.floor(y)) - 1,
        int(np.ceil(x + wide)) + 1,
        int(np.ceil(y + high)) + 1,
    )
    box = _cut(around, width, height)
    if box is None:
        return None
    moved = np.asarray(polygon).reshape(-1, 2) - around[:2]
    # Drawn in a frame of its own, so that the pixels outside the picture count too.
    whole = mask_of_outline(
        [moved.ravel().tolist()], height=around[3] - around[1], width=around[2] - around[0]
    )
    left, top, right, bottom = box
    mask = whole[top - around[1] : bottom - around[1], left - around[0] : right - around[0]] != 0
    return Layer(index, True, box, mask, int(whole.sum()), cap.centre[2])


def _layer_of_stalk(index: int, stalk: Stalk, width: int, height: int) -> Layer | None:
    box = _cut(bounds_of_stalk(stalk), width, height)
    if box is None:
        return None
    mask = cover_of_stalk(stalk, box) >= 0.5
    # Not far up, since a cap that stands in front of the foot hides the stalk, and never over its own cap.
    order = min(stalk.foot[2] + STALK_ORDER * (stalk.head[2] - stalk.foot[2]), stalk.head[2] - 1e-3)
    return Layer(index, False, box, mask, int(mask.sum()), order)


def _cut(box: Box, width: int, height: int) -> Box | None:
    left, top, right, bottom = max(box[0], 0), max(box[1], 0), min(box[2], width), min(box[3], height)
    return (left, top, right, bottom) if left < right and top < bottom else None
