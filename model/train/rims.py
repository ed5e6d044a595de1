"""How much further out than the network people draw rims, so that it can be told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fairyring.model.geometry.raster import area_of_rle, iou_matrix, rle_of_outline
from fairyring.model.predict.seen import Detection
from fairyring.model.train.data import Example

CLEARLY = 0.75
"""IoU from which a detection tells where its cap's rim was drawn."""
FEWEST = 30
"""With fewer of them nothing is told."""
LOGITS_PER_PX = 3.0
"""What has to be added to a mask's logits for its rim to move out by a pixel, about."""
MOST = 2.0
"""Largest shift, logits: what asks for more is no matter of how rims are drawn."""


def fitting_rim(examples: Sequence[Example], found: Sequence[Sequence[Detection]], *, rim: float) -> float:
    """The ``rim`` of a network by which its rims lie, on average, where they were drawn.

    ``found``: what it found in each example with the ``rim`` that it has now. Compared are the radii of
    circles of the visible areas.
    """
    further_out: list[float] = []
    for example, detections in zip(examples, found, strict=True):
        size = {"width": example.width, "height": example.height}
        drawn, seen = (
            [rle_of_outline(outline, **size) for outline in example.caps],
            [d.rle for d in detections],
        )
        if not drawn or not seen:
            continue
        overlap = iou_matrix(drawn, seen)
        for nth, best in enumerate(overlap.argmax(1).tolist()):
            if overlap[nth, best] >= CLEARLY:
                areas = np.array([area_of_rle(drawn[nth]), area_of_rle(seen[best])])
                further_out.append(float(np.subtract(*np.sqrt(areas / np.pi))))
    if len(further_out) < FEWEST:
        return rim
    return float(np.clip(rim + LOGITS_PER_PX * np.median(further_out), -MOST, MOST))
