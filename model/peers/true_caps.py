"""The caps of one photo of a batch, as the losses of both peers need them."""

from __future__ import annotations

from typing import NamedTuple

from torch import Tensor

from fairyring.model.network.boxes import boxes_of
from fairyring.model.network.objective import Batch
from fairyring.model.peers.boxes import corners_of


class TrueCaps(NamedTuple):
    """k caps."""

    nth: int
    """Of the photo in its batch."""
    boxes: Tensor
    """(k, 4): left, top, right, bottom, photo pixels."""
    masks: Tensor
    """(k, H, W) uint8: 1 on the visible cap."""
    ignored: Tensor
    """(H, W) bool: where it is not said whether there is a cap."""


def true_caps(batch: Batch) -> list[TrueCaps]:
    """Those of each photo of the batch."""
    found = []
    for nth, caps in enumerate(batch.caps):
        some = len(caps.masks) > 0
        boxes = corners_of(boxes_of(caps.masks.bool())) if some else batch.origins.new_zeros(0, 4)
        found.append(TrueCaps(nth, boxes, caps.masks, caps.ignored))
    return found
