"""How the shipped weights find out how wide the caps of a photo are."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from fairyring.app.bench.network.sets import rendered
from fairyring.model.network.weights import load_weights
from fairyring.model.photo import Pixels
from fairyring.model.predict.passes import resized
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import diameter_in, see_at_its_scale
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.progress import silent


@pytest.fixture(scope="module")
def predictor() -> Predictor:
    return Predictor(load_weights(SHIPPED).network, device=torch.device("cpu"))


@pytest.fixture(scope="module")
def bed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Pixels, float]:
    """A bed like those of a farm, and the median diameter of its caps, of what is visible."""
    beds = rendered("farm", tmp_path_factory.mktemp("beds"), count=1, progress=silent)
    _, photo = next(beds.images())
    areas = [cap["area"] for cap in beds.document["annotations"]]
    return photo, float(np.median((4 * np.array(areas) / np.pi) ** 0.5))


@pytest.mark.parametrize("diameter", [12, 20, 45, 90, 200])
def test_the_width_of_caps_is_found_within_a_fifth(
    predictor: Predictor, bed: tuple[Pixels, float], diameter: float
) -> None:
    photo, now = bed
    assert diameter_in(predictor, resized(photo, diameter / now)) == pytest.approx(diameter, rel=0.2)


def test_a_photo_of_three_times_the_pixels_is_read_as_it_was(
    predictor: Predictor, bed: tuple[Pixels, float]
) -> None:
    photo = bed[0][100:500, 100:740]
    seen, large = see_at_its_scale(predictor, photo), see_at_its_scale(predictor, resized(photo, 3))
    assert large.width == 3 * seen.width
    certain = [sum(cap.score > 0.5 for cap in predictor.read(each)) for each in (seen, large)]
    assert certain[0] > 30
    assert certain[1] == pytest.approx(certain[0], rel=0.15)


@pytest.mark.parametrize(("left", "top"), [(1000, 700), (2000, 1200), (3000, 1700)])
def test_a_photo_of_a_few_large_caps_is_not_enlarged(
    predictor: Predictor, bed: tuple[Pixels, float], left: int, top: int
) -> None:
    photo, now = bed
    few = resized(photo, 200 / now)[top : top + 500, left : left + 500]
    assert see_at_its_scale(predictor, few).scaled[0] <= 500


def test_a_width_that_is_given_is_taken(predictor: Predictor, bed: tuple[Pixels, float]) -> None:
    assert see_at_its_scale(predictor, bed[0][:200, :200], diameter=25).scaled == (400, 400)


def test_nothing_is_found_in_a_photo_of_nothing(predictor: Predictor) -> None:
    nothing = np.full((90, 120, 3), 30, np.uint8)
    assert diameter_in(predictor, nothing) is None
    assert see_at_its_scale(predictor, nothing).scaled == (120, 90)
