"""The second look's calibration: qualities that are IoUs on average, and standard deviations that hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse, parameters_of
from fairyring.model.geometry.raster import Rle, iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import Shape
from fairyring.model.predict.calibration import Calibration, fit_calibration
from fairyring.model.predict.seen import Detection
from fairyring.model.train.data import Example

SAME_CAP = 0.5
"""IoU from which a detection is of a cap."""
WITHIN_ONE = 0.6827
"""Share of a normal distribution within a standard deviation."""
FEWEST = 30
"""With fewer whole outlines than this standard deviations stay as they are."""


@dataclass(frozen=True, kw_only=True)
class SecondLookCalibration:
    """As `SecondLook` keeps it."""

    quality: Calibration
    spread: tuple[float, ...]
    """Factors on the standard deviations of the five parameters."""


def fit_second_look(
    examples: Sequence[Example], found: Sequence[Sequence[Detection]]
) -> SecondLookCalibration:
    """By what was found, uncalibrated, in each example."""
    qualities, ious, deviations = [], [], [np.zeros((0, 5))]
    for example, detections in zip(examples, found, strict=True):
        masks = [detection.rle for detection in detections]
        overlap = iou_matrix([_rle(outline, example) for outline in example.caps], masks)
        unknown = iou_matrix([_rle(outline, example) for outline in example.ignored], masks)
        best = overlap.max(0, initial=0)
        counted = best >= unknown.max(0, initial=0)
        for nth, detection in enumerate(detections):
            if detection.quality is None or detection.whole is None or not counted[nth]:
                continue
            qualities.append(detection.quality)
            ious.append(best[nth])
            owner = int(overlap[:, nth].argmax()) if best[nth] >= SAME_CAP else -1
            whole = example.wholes[owner] if example.wholes and owner >= 0 else None
            if whole is not None:
                deviations.append(deviation(detection.whole, whole)[None])
    quality = fit_calibration(np.array(qualities), np.array(ious, np.float64))
    return SecondLookCalibration(quality=quality, spread=_spread(np.concatenate(deviations)))


def deviation(likely: LikelyEllipse, true: Shape) -> NDArray[np.float64]:
    """(5,): how far each parameter of the true outline lies off, in standard deviations."""
    parameters = np.array(likely.parameters)
    away = parameters_of(true) - parameters
    away[:2] /= np.exp(parameters[2])
    return away / np.sqrt(np.diagonal(np.array(likely.covariance)))


def _spread(deviations: NDArray[np.float64]) -> tuple[float, ...]:
    """Such that 68 % of the deviations (n, 5) come to lie within one."""
    if len(deviations) < FEWEST:
        return (1.0,) * deviations.shape[1]
    return tuple(np.quantile(np.abs(deviations), WITHIN_ONE, axis=0).tolist())


def _rle(outline: list[list[float]], example: Example) -> Rle:
    return rle_of_outline(outline, height=example.height, width=example.width)
