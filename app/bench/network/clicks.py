"""How good the cap at one click is, on photos whose caps are known: of all caps, and of those missed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.app.bench.network.tables import CERTAIN
from fairyring.model.geometry.boxes import box_of_outline
from fairyring.model.geometry.raster import Rle, iou_matrix, mask_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import Outline, area_of_outline
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import see_at_its_scale
from fairyring.model.predict.seen import Detection, Seen

LEAST_IOU, CLOSE_IOU = 0.5, 0.75
Ask = Callable[[Seen, Outline, list[Outline]], Detection | None]
"""Asks for a cap of this outline, in front of which others lie."""
BUD_PX = 15.0
"""Diameter under which a cap is called a bud here, of a circle of what is visible."""


def click_rows(predictor: Predictor, photos: LabelledPhotos) -> list[dict[str, Any]]:
    """One click in the middle of every cap, and a box around it: shares of IoU .5 and .75, and the time each.

    The time is that of the process on all cores together, which other work on the machine does not change.

    A cap is missed if no prediction of score .5 or more has an IoU of .5 with it; at a missed one, the others
    that were found lie in front. Buds are smaller than BUD_PX.
    """
    asked: dict[str, Ask] = {
        "click": lambda seen, outline, front: predictor.at(seen, [_middle_of(outline, seen)], front=front),
        "box": lambda seen, outline, front: predictor.within(seen, box_of_outline(outline), front=front),
    }
    likeness: dict[tuple[str, str], list[float]] = {}
    times: dict[str, list[float]] = {name: [] for name in asked}
    for entry, pixels in photos.images():
        outlines = [
            cap["segmentation"]
            for cap in photos.document["annotations"]
            if cap["image_id"] == entry["id"] and not cap.get("ignore")
        ]
        truths = [_rle(outline, entry) for outline in outlines]
        seen = see_at_its_scale(predictor, pixels)
        found = [one for one in predictor.read(seen) if one.score >= CERTAIN]
        overlap = iou_matrix(truths, [one.rle for one in found])
        missed = overlap.max(1, initial=0) < LEAST_IOU
        front = [one.outline for one in found]
        for outline, truth, was_missed in zip(outlines, truths, missed.tolist(), strict=True):
            for name, ask in asked.items():
                began = time.process_time()
                cap = ask(seen, outline, front if was_missed else [])
                times[name].append(time.process_time() - began)
                likeness.setdefault((name, "all"), []).append(_iou(truth, cap))
                if math.sqrt(4 * area_of_outline(outline) / math.pi) < BUD_PX:
                    likeness.setdefault((name, "buds"), []).append(_iou(truth, cap))
                if was_missed:
                    likeness.setdefault((name, "missed"), []).append(_iou(truth, cap))
    return [_row(photos.name, *of, ious, times[of[0]]) for of, ious in sorted(likeness.items())]


def _row(name: str, asked: str, caps_of: str, ious: list[float], seconds: list[float]) -> dict[str, Any]:
    figures = np.array(ious)
    return {
        "set": name,
        "asked_by": asked,
        "caps_of": caps_of,
        "caps": len(ious),
        "IoU_.5": round(float((figures >= LEAST_IOU).mean()), 4),
        "IoU_.75": round(float((figures >= CLOSE_IOU).mean()), 4),
        "cpu_ms_median": round(1000 * float(np.median(seconds)), 1),
        "cpu_ms_p95": round(1000 * float(np.quantile(seconds, 0.95)), 1),
    }


def _middle_of(outline: Outline, seen: Seen) -> tuple[float, float]:
    """Where a person would click: the middle of the pixel furthest inside the outline."""
    mask = mask_of_rle(rle_of_outline(outline, height=seen.height, width=seen.width))
    inside: NDArray[np.float32] = np.asarray(
        cv2.distanceTransform(np.pad(mask, 1), cv2.DIST_L2, cv2.DIST_MASK_5), np.float32
    )[1:-1, 1:-1]
    row, column = np.unravel_index(int(inside.argmax()), inside.shape)
    return float(column) + 0.5, float(row) + 0.5


def _rle(outline: Outline, entry: dict[str, Any]) -> Rle:
    return rle_of_outline(outline, height=entry["height"], width=entry["width"])


def _iou(truth: Rle, cap: Detection | None) -> float:
    return 0.0 if cap is None else float(iou_matrix([truth], [cap.rle])[0, 0])
