"""Validation: a network's predictions on labelled photos against the labels."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from msgspec import to_builtins
from msgspec.structs import replace

from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.masks import score_masks
from fairyring.model.evaluate.outcomes import joined, outcomes_of_page
from fairyring.model.evaluate.pages import Page
from fairyring.model.geometry.raster import Rle, rle_of_outline
from fairyring.model.geometry.shapes import Outline
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.predict.calibration import Calibration, calibrated, fit_calibration
from fairyring.model.predict.predictor import PredictConfig, Predictor
from fairyring.model.predict.seen import Detection
from fairyring.model.progress import Progress, silent
from fairyring.model.train.calibrating import SecondLookCalibration, fit_second_look
from fairyring.model.train.data import Example, read_rgb
from fairyring.model.train.rims import fitting_rim


@dataclass(frozen=True, kw_only=True)
class Validation:
    """The result of a validation."""

    figures: dict[str, Any]
    """The figures of ``evaluate masks``, with calibrated scores."""
    calibration: Calibration
    """The calibration of the network's scores on these examples, at IoU .5."""
    second_look: SecondLookCalibration | None
    """The calibration of its second look; None where it takes none."""
    rim: float
    """The network's ``rim`` that fits these examples."""


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
    if raw.second_look is not None:
        raw.second_look.quality_line.copy_(torch.tensor(Calibration()))
        raw.second_look.spread.fill_(1.0)
    predictor = Predictor(raw, device=device, settings=settings)
    found = []
    for nth, example in enumerate(examples):
        progress(nth, len(examples), f"validating on {example.path.name}")
        found.append(predictor.detect(read_rgb(example.path)))
    pages = [page_of(example, detections) for example, detections in zip(examples, found, strict=True)]
    outcomes = joined([outcomes_of_page(page) for page in pages])
    counted = ~outcomes.dropped
    calibration = fit_calibration(outcomes.score[counted], outcomes.right[counted])
    figures = to_builtins(score_masks([_calibrated(page, calibration) for page in pages]))
    second = fit_second_look(examples, found) if raw.second_look is not None else None
    rim = fitting_rim(examples, found, rim=float(raw.rim))
    return Validation(figures=figures, calibration=calibration, second_look=second, rim=rim)


def calibrate(network: PRSOLOv2, validation: Validation) -> None:
    """Has the network say what the validation found that it means."""
    network.calibration.copy_(torch.tensor(validation.calibration))
    network.rim.fill_(validation.rim)
    second = validation.second_look
    if network.second_look is not None and second is not None:
        network.second_look.quality_line.copy_(torch.tensor(second.quality))
        network.second_look.spread.copy_(torch.tensor(second.spread))


def page_of(example: Example, found: Sequence[Detection]) -> Page:
    """A labelled photo and what was detected in it, as evaluation compares them."""
    return Page(
        file_name=example.path.name,
        width=example.width,
        height=example.height,
        truths=[
            CapRecord(rle=_rle(outline, example), ignored=ignored)
            for ignored, outlines in ((False, example.caps), (True, example.ignored))
            for outline in outlines
        ],
        predictions=[CapRecord(rle=detection.rle, score=detection.score) for detection in found],
        light=example.light,
        form=example.form,
    )


def _calibrated(page: Page, calibration: Calibration) -> Page:
    predictions = [
        replace(cap, score=float(calibrated(np.array(cap.score), calibration))) for cap in page.predictions
    ]
    return replace(page, predictions=predictions)


def _rle(outline: Outline, example: Example) -> Rle:
    return rle_of_outline(outline, height=example.height, width=example.width)
