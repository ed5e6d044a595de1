"""A closer look at what is too small where the photo is seen as a whole."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
import torch

from fairyring.model.network.weights import load_weights
from fairyring.model.photo import Pixels
from fairyring.model.predict.close_up import cap_at_points
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection, Seen
from fairyring.model.predict.shipped import SHIPPED

BUD, CAP, CORNER = (200.0, 60.0, 6.0), (90.0, 120.0, 40.0), (4.0, 4.0, 5.0)
"""Middles and radii of discs."""


@pytest.fixture(scope="module")
def predictor() -> Predictor:
    return Predictor(load_weights(SHIPPED).network, device=torch.device("cpu"))


@pytest.fixture(scope="module")
def photo() -> Pixels:
    ground = np.full((256, 320, 3), 40, np.uint8)
    for x, y, r in (BUD, CAP, CORNER):
        # The middle of pixel i is i + 0.5, for OpenCV i; it takes sixteenths.
        middle = round(16 * x - 8), round(16 * y - 8)
        cv2.circle(ground, middle, round(16 * r), (215, 222, 225), -1, cv2.LINE_AA, 4)
    return np.asarray(cv2.GaussianBlur(ground, (3, 3), 0), np.uint8)


@pytest.fixture(scope="module")
def seen(predictor: Predictor, photo: Pixels) -> Seen:
    return predictor.see(photo)


def radii_about(found: Detection, x: float, y: float) -> np.ndarray:
    xs, ys = np.reshape(found.outline[0], (-1, 2)).T
    return np.hypot(xs - x, ys - y)


def test_a_bud_is_found_where_it_lies(predictor: Predictor, photo: Pixels, seen: Seen) -> None:
    x, y, r = BUD
    found = cap_at_points(predictor, photo, seen, [(x, y)])
    assert found is not None
    assert radii_about(found, x, y).mean() == pytest.approx(r, abs=1.5)
    assert found.whole is not None
    assert found.whole.parameters[:2] == pytest.approx((x, y), abs=2)
    assert found.rle["size"] == [256, 320]


def test_a_large_cap_is_answered_as_ever(predictor: Predictor, photo: Pixels, seen: Seen) -> None:
    x, y, r = CAP
    found, before = cap_at_points(predictor, photo, seen, [(x, y)]), predictor.at(seen, [(x, y)])
    assert found is not None
    assert before is not None
    assert found.outline == before.outline
    assert radii_about(found, x, y).mean() == pytest.approx(r, abs=2)


def test_what_lies_in_front_of_a_bud_is_cut_off(predictor: Predictor, photo: Pixels, seen: Seen) -> None:
    x, y, _ = BUD
    front = [[[x + 2, y - 20, x + 40, y - 20, x + 40, y + 20, x + 2, y + 20]]]
    found = cap_at_points(predictor, photo, seen, [(x - 2, y)], front=front)
    assert found is not None
    assert max(found.outline[0][::2]) < x + 3


def test_a_bud_in_the_corner_of_a_photo_is_found_too(predictor: Predictor, photo: Pixels, seen: Seen) -> None:
    x, y, r = CORNER
    found = cap_at_points(predictor, photo, seen, [(x, y)])
    assert found is not None
    assert radii_about(found, x, y).mean() == pytest.approx(r, abs=2)
