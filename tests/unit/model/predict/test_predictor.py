"""Predictions of a network that knows refined discs: whole, once each, wherever the tiles are cut."""

from __future__ import annotations

import math

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from pycocotools import mask as pycocotools_mask

from fairyring.model.geometry.raster import iou_matrix
from fairyring.model.geometry.shapes import area_of_outline, bounds_of_outline
from fairyring.model.network.decode import DecodeConfig, Instances
from fairyring.model.network.refine import RefinedMask
from fairyring.model.network.weights import load_weights
from fairyring.model.predict import passes, tiles
from fairyring.model.predict.calibration import Calibration, calibrated
from fairyring.model.predict.passes import Pass, resized
from fairyring.model.predict.predictor import PredictConfig, Predictor
from fairyring.model.predict.seen import Detection
from fairyring.model.train.data import read_rgb
from tests.support.discs import DISCS, SIDE, photo_of
from tests.support.small_networks import tiny
from tests.unit.model.conftest import Learnt

CPU = torch.device("cpu")
SURE = 0.35
"""What the tiny network is sure of; what it finds twice has less than half of this."""


@pytest.fixture(scope="module")
def predictor(learnt: Learnt) -> Predictor:
    return Predictor(load_weights(learnt.result.weights).network, device=CPU)


def middle(detection: Detection) -> tuple[float, float]:
    x, y, width, height = bounds_of_outline(detection.outline)
    return x + width / 2, y + height / 2


def sure(detections: list[Detection]) -> list[Detection]:
    return [detection for detection in detections if detection.score >= SURE]


@pytest.mark.timeout(280)
def test_discs_are_found_where_they_are(predictor: Predictor, learnt: Learnt) -> None:
    for example, discs in zip(learnt.examples, DISCS, strict=True):
        found = predictor.detect(read_rgb(example.path))
        assert [one.score for one in found] == sorted((one.score for one in found), reverse=True)
        found = sure(found)
        assert len(found) == len(discs)
        for cx, cy, r in discs:
            nearest = min(found, key=lambda one: math.dist(middle(one), (cx, cy)))
            assert middle(nearest) == pytest.approx((cx, cy), abs=1.5)
            assert area_of_outline(nearest.outline) == pytest.approx(math.pi * r**2, rel=0.1)


def test_the_pixels_are_pycocotools_of_the_outline(predictor: Predictor, learnt: Learnt) -> None:
    for found in sure(predictor.detect(read_rgb(learnt.examples[0].path))):
        codes = pycocotools_mask.frPyObjects(found.outline, SIDE, SIDE)  # pyright: ignore
        expected = pycocotools_mask.decode(pycocotools_mask.merge(codes))
        np.testing.assert_array_equal(pycocotools_mask.decode(found.rle), expected)  # pyright: ignore


def test_outlines_stay_in_the_photo_whatever_its_size(predictor: Predictor) -> None:
    whole = photo_of(DISCS[0], width=SIDE, height=SIDE)
    for height, width in ((100, 75), (33, 128), (1, 1), (128, 97)):
        for found in predictor.detect(whole[:height, :width]):
            assert found.rle["size"] == [height, width]
            x, y, wide, tall = bounds_of_outline(found.outline)
            assert x >= 0
            assert y >= 0
            assert x + wide <= width
            assert y + tall <= height


def test_a_photo_of_nothing_has_no_caps() -> None:
    assert Predictor(tiny(), device=CPU).detect(np.zeros((64, 96, 3), np.uint8)) == []


def same(first: list[Detection], second: list[Detection]) -> bool:
    pairs = zip(sure(first), sure(second), strict=True)
    return all(abs(a.score - b.score) < 1e-3 and math.dist(middle(a), middle(b)) < 0.05 for a, b in pairs)


def test_what_was_seen_is_read_with_other_settings(predictor: Predictor, learnt: Learnt) -> None:
    seen = predictor.see(read_rgb(learnt.examples[0].path))
    assert len(predictor.read(seen, DecodeConfig(most=2))) == 2


def test_scores_are_calibrated_and_those_too_low_are_not_told(learnt: Learnt) -> None:
    photo = read_rgb(learnt.examples[0].path)
    line = Calibration(1.5, -0.4)

    def detected(calibration: Calibration, least: float) -> list[float]:
        network = load_weights(learnt.result.weights).network
        network.calibration.copy_(torch.tensor(calibration))
        settings = PredictConfig(least_score=least)
        return [one.score for one in Predictor(network, device=CPU, settings=settings).detect(photo)]

    expected = calibrated(np.array(detected(Calibration(), 0.0)), line)
    assert detected(line, 0.0) == pytest.approx(expected.tolist(), abs=1e-5)
    assert detected(line, SURE) == pytest.approx(expected[expected >= SURE].tolist(), abs=1e-5)


@pytest.fixture
def small_tiles(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tiles, "LONGEST", SIDE)
    monkeypatch.setattr(tiles, "SHORTEST", SIDE)
    monkeypatch.setattr(passes, "OVERLAP", 64)


def quilt() -> tuple[NDArray[np.uint8], list[tuple[float, float, float]]]:
    """A photo of 192 × 128: two tiles with a seam at 96, discs on it and on either side."""
    discs = ((30.0, 34.0, 17.0), (94.4, 36.0, 22.0), (98.2, 92.0, 20.0), (160.0, 90.0, 24.0))
    return photo_of(discs, width=192, height=SIDE), list(discs)


@pytest.mark.usefixtures("small_tiles")
def test_caps_at_seams_are_whole_and_found_once(predictor: Predictor) -> None:
    photo, discs = quilt()
    assert len(tiles.tiles_of(192, SIDE, overlap=64)) == 2
    found = sure(predictor.detect(photo))
    assert len(found) == len(discs)
    overlaps = iou_matrix([one.rle for one in found], [one.rle for one in found])
    assert (overlaps - np.eye(len(found))).max() < 0.05
    for cx, cy, r in discs:
        nearest = min(found, key=lambda one: math.dist(middle(one), (cx, cy)))
        assert middle(nearest) == pytest.approx((cx, cy), abs=2)
        assert area_of_outline(nearest.outline) == pytest.approx(math.pi * r**2, rel=0.12)


@pytest.mark.usefixtures("small_tiles")
@pytest.mark.parametrize("shift", [-0.4, 0.0, 0.4])
def test_a_cap_whose_middle_is_on_the_seam_is_neither_lost_nor_told_twice(
    monkeypatch: pytest.MonkeyPatch, shift: float
) -> None:
    """The two tiles place its middle a little to this or that side of the seam, at 96."""
    middles = iter([96 + shift, 96 - 64 - shift])
    y, x = torch.meshgrid(torch.arange(SIDE) + 0.5, torch.arange(SIDE) + 0.5, indexing="ij")

    def refined(*_: object, **__: object) -> list[RefinedMask]:
        return [RefinedMask(0, 0, 20 - torch.hypot(x - next(middles), y - 64))]

    found = Instances(torch.tensor([0.9]), torch.zeros(1, 32), torch.ones(1, 32, 32))
    monkeypatch.setattr("fairyring.model.predict.predictor.decode", lambda *_: found)
    monkeypatch.setattr("fairyring.model.predict.predictor.refine", refined)
    (cap,) = Predictor(tiny(), device=CPU).detect(np.zeros((SIDE, 192, 3), np.uint8))
    assert middle(cap) == pytest.approx((96, 64), abs=0.5)


@pytest.mark.usefixtures("small_tiles")
def test_pieces_seen_together_are_read_as_if_seen_one_by_one(predictor: Predictor) -> None:
    photo, discs = quilt()
    batched = Predictor(predictor.network, device=CPU, settings=PredictConfig(batch=4))
    alone = predictor.detect(photo)
    assert len(sure(alone)) == len(discs)
    assert same(alone, batched.detect(photo))


def test_a_photo_at_another_scale_gives_the_same_caps_in_its_own_pixels(
    predictor: Predictor, learnt: Learnt
) -> None:
    photo = read_rgb(learnt.examples[0].path)
    large = resized(photo, 3.0)
    found = sure(predictor.detect(large, scale=1 / 3))
    assert {tuple(one.rle["size"]) for one in found} == {(3 * SIDE, 3 * SIDE)}
    for before, after in zip(sure(predictor.detect(photo)), found, strict=True):
        assert np.divide(middle(after), 3) == pytest.approx(middle(before), abs=0.3)
        assert area_of_outline(after.outline) / 9 == pytest.approx(area_of_outline(before.outline), rel=0.03)


def test_caps_are_taken_from_the_pass_that_is_for_their_size(predictor: Predictor, learnt: Learnt) -> None:
    """The discs are 25, 34, 44 and 50 pixels wide."""
    photo = read_rgb(learnt.examples[0].path)
    for only, expected in ((Pass(most=39), [25, 34]), (Pass(least=39), [44, 50])):
        chosen = Predictor(predictor.network, device=CPU, settings=PredictConfig(passes=(only,)))
        found = [2 * (area_of_outline(one.outline) / math.pi) ** 0.5 for one in sure(chosen.detect(photo))]
        assert sorted(found) == pytest.approx(expected, abs=2)
