import numpy as np
import pytest

from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.statistics import Statistics


def disc(x: int, y: int, r: float) -> Silhouette:
    row, column = np.mgrid[0:81, 0:81]
    return Silhouette((np.hypot(column - 40, row - 40) <= r).astype(np.uint8), x, y)


def statistics_of(radii: list[float]) -> Statistics:
    caps = [disc(100 * at, 20, r) for at, r in enumerate(radii)]
    return fitted_image(caps, width=100 * len(radii), height=120).statistics


def test_eight_caps_in_view_tell_the_size_of_caps():
    statistics = statistics_of([12.0, 15.0, 18.0, 20.0, 20.0, 22.0, 27.0, 34.0])
    assert statistics.size == pytest.approx(np.log(20.3), abs=0.05)
    # The spread of log r about its median is 0.30, by hand.
    assert statistics.size_precision == pytest.approx(0.30**-2, rel=0.1)


def test_caps_all_alike_are_not_taken_to_be_more_alike_than_caps_are():
    assert statistics_of([25.0] * 8).size_precision == pytest.approx(0.2**-2)


def test_seven_caps_tell_no_size():
    assert statistics_of([25.0] * 7).size_precision == 0
