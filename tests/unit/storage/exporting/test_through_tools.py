"""An export goes through other tools and back; `python -m tests.round_trips.table` shows them all."""

import pytest

from tests.round_trips.trip import PACKAGES, NotInstalledError, taken_through


@pytest.fixture(params=PACKAGES)
def trip(request, tmp_path):
    try:
        return taken_through(request.param, tmp_path)
    except NotInstalledError:
        pytest.skip(f"{request.param} is not installed here")


def test_the_project_that_a_file_comes_back_to_knows_every_cap_of_it(trip):
    assert (trip.back.annotations, trip.back.known, trip.back.gone) == (0, 5, 0)
    assert trip.least_iou > 0.98


def test_pycocotools_keeps_every_number_and_outline(tmp_path):
    pytest.importorskip("pycocotools")
    trip = taken_through("pycocotools", tmp_path)
    assert (trip.images, trip.categories, trip.annotations) == ((2, 2), (2, 2), (5, 5))
    assert (trip.least_iou, trip.back.changed) == (1.0, 0)
