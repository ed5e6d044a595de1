"""Validation: a network's predictions on labelled photos against the labels, as COCO documents."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.evaluate.outcomes import joined, outcomes_of_page
from fairyring.model.evaluate.pages import pages_of
from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.predict.calibration import Calibration, calibrated, fit_calibration
from fairyring.model.predict.predictor import Detection, PredictConfig, Predictor
from fairyring.model.progress import Progress, silent
from fairyring.model.train.data import Example, read_rgb


@dataclass(frozen=True, kw_only=True)
class Validation:
    """The result of a validation."""

    figures: dict[str, Any]
    """The figures of ``evaluate masks``, with calibrated scores."""
    calibration: Calibration
    """The calibration of the network's scores on these examples, at IoU .5."""


def validate(
    network: PRSOLOv2,
    examples: Sequence[Example],
    *,
    device: torch.device,
    settings: PredictConfig | None = None,
    progress: Progress = silent,
) -> Validation:
    """Validates a copy of the network; the calibration that it has already plays no part."""
    raw = copy.deepcopy(network)
    raw.calibration.copy_(torch.tensor(Calibration()))
    predictor = Predictor(raw, device=device, settings=settings)
    found = []
    for nth, example in enumerate(examples):
        progress(nth, len(examples), f"validating on {example.path.name}")
        found.append(predictor.detect(read_rgb(example.path)))
    labels, said = document_of_labels(examples), document_of_detections(examples, found)
    pages = pages_of(said, labels, masks=True, centres=False)
    outcomes = joined([outcomes_of_page(page) for page in pages])
    counted = ~outcomes.dropped
    calibration = fit_calibration(outcomes.score[counted], outcomes.right[counted])
    for cap in said["annotations"]:
        cap["score"] = float(calibrated(np.array(cap["score"]), calibration))
    return Validation(figures=evaluate_masks(said, labels), calibration=calibration)


def document_of_labels(examples: Sequence[Example]) -> dict[str, Any]:
    """The labels as a COCO document; ignored regions carry ``ignore``."""
    annotations = [
        {"image_id": nth, "segmentation": _rle(outline, example), "ignore": ignored}
        for nth, example in enumerate(examples, start=1)
        for ignored, outlines in ((False, example.caps), (True, example.ignored))
        for outline in outlines
    ]
    return _document(examples, annotations)


def document_of_detections(
    examples: Sequence[Example], found: Sequence[Sequence[Detection]]
) -> dict[str, Any]:
    """Predictions as a COCO document, in the order of the examples."""
    annotations = [
        {"image_id": nth, "segmentation": detection.rle, "score": detection.score}
        for nth, detections in enumerate(found, start=1)
        for detection in detections
    ]
    return _document(examples, annotations)


def _rle(outline: list[list[float]], example: Example) -> dict[str, Any]:
    return rle_of_outline(outline, height=example.height, width=example.width)


def _document(examples: Sequence[Example], annotations: list[dict[str, Any]]) -> dict[str, Any]:
    images = []
    for nth, example in enumerate(examples, start=1):
        size = {"width": example.width, "height": example.height}
        groups = {"light": example.light, "form": example.form}
        # Photos of one name may lie in several folders; here each is its own.
        images.append({"id": nth, "file_name": f"{nth}.png", **size, **groups})
    numbered = [{"id": nth, "category_id": 1, **cap} for nth, cap in enumerate(annotations, start=1)]
    return {"images": images, "annotations": numbered, "categories": [{"id": 1, "name": "mushroom"}]}
