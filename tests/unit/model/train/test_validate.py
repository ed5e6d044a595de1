"""Validation: a network's predictions beside the labels, and their figures."""

from __future__ import annotations

import math

import pytest
import torch
from pycocotools import mask as pycocotools_mask

from fairyring.model.network.weights import load_weights
from fairyring.model.predict.calibration import Calibration
from fairyring.model.predict.predictor import Predictor
from fairyring.model.train.data import Example, read_rgb
from fairyring.model.train.validate import page_of, validate
from tests.support.discs import DISCS
from tests.unit.model.conftest import Learnt

CPU = torch.device("cpu")


@pytest.mark.timeout(280)
def test_validation_leaves_the_network_as_it_is(learnt: Learnt) -> None:
    network = load_weights(learnt.result.weights).network.train()
    before = {key: value.clone() for key, value in network.state_dict().items()}
    said: list[tuple[int, int, str]] = []
    figures = validate(network, learnt.examples, device=CPU, progress=lambda *told: said.append(told)).figures
    assert figures["AP"] > 0.95
    assert figures["S50"] == 1
    assert network.training
    assert network.state_dict().keys() == before.keys()
    assert all(torch.equal(value, before[key]) for key, value in network.state_dict().items())
    assert said == [(0, 2, "validating on discs-0.png"), (1, 2, "validating on discs-1.png")]


def test_trained_weights_carry_the_calibration_that_fits_them(learnt: Learnt) -> None:
    network = load_weights(learnt.result.weights).network
    expected = validate(network, learnt.examples, device=CPU).calibration
    assert expected != Calibration()
    assert network.calibration.tolist() == pytest.approx(list(expected), rel=0.05)


def test_labels_and_detections_are_compared_as_masks(learnt: Learnt) -> None:
    predictor = Predictor(load_weights(learnt.result.weights).network, device=CPU)
    for example, discs in zip(learnt.examples, DISCS, strict=True):
        found = predictor.detect(read_rgb(example.path))
        page = page_of(example, found)
        assert (page.file_name, page.width, page.height) == (example.path.name, example.width, example.height)
        for cap, (_, _, r) in zip(page.truths, discs, strict=True):
            area = pycocotools_mask.area(cap.rle)  # pyright: ignore
            assert area == pytest.approx(math.pi * r**2, rel=0.02)
            assert not cap.ignored
        assert [cap.score for cap in page.predictions] == [detection.score for detection in found]


def test_ignored_regions_and_groups_are_told(learnt: Learnt) -> None:
    one = learnt.examples[0]
    example = Example(
        path=one.path, width=128, height=128, caps=one.caps[:1], ignored=one.caps[1:], light="top", form="d"
    )
    page = page_of(example, [])
    assert [cap.ignored for cap in page.truths] == [False, True, True, True]
    assert (page.light, page.form) == ("top", "d")
