"""Pan and zoom."""

from __future__ import annotations

import random

import pytest

SIZE = {"width": 1016, "height": 850}


def test_zooming_keeps_the_point_under_the_pointer(call) -> None:
    chance = random.Random(1)
    for _ in range(20):
        view = {
            "scale": chance.uniform(0.1, 20),
            "x": chance.uniform(-900, 900),
            "y": chance.uniform(-900, 900),
        }
        x, y, factor = chance.uniform(0, 1000), chance.uniform(0, 800), chance.uniform(0.3, 3)
        body = """
          const after = m.zoomed(a.view, {x: a.x, y: a.y, factor: a.factor, smallest: 0.01});
          return [m.toImage(a.view, a.x, a.y), m.toImage(after, a.x, a.y), after.scale];
        """
        before, after, scale = call("geometry/view", body, {"view": view, "x": x, "y": y, "factor": factor})
        assert after == pytest.approx(before, abs=1e-6)
        assert scale == pytest.approx(min(view["scale"] * factor, 64))


def test_zooming_stops_at_the_smallest_scale_without_drifting(call) -> None:
    body = "return m.zoomed({scale: 0.5, x: 10, y: 20}, {x: 300, y: 200, factor: 0.1, smallest: 0.5})"
    assert call("geometry/view", body) == {"scale": 0.5, "x": 10, "y": 20}


def test_fitting_centres_the_whole_photo_inside_the_margin(call) -> None:
    photo = {"x0": 0, "y0": 0, "x1": 1280, "y1": 720}
    view = call("geometry/view", "return m.fitted(a.photo, a.size, 12)", {"photo": photo, "size": SIZE})
    assert view["scale"] == pytest.approx((1016 - 24) / 1280)
    assert view["x"] == pytest.approx(12)
    assert view["y"] == pytest.approx((850 - 720 * view["scale"]) / 2)


@pytest.mark.parametrize(
    ("bounds", "expected"),
    [
        ({"x0": 400, "y0": 300, "x1": 500, "y1": 400}, (0, 0)),
        ({"x0": -50, "y0": 300, "x1": 50, "y1": 400}, (90, 0)),
        ({"x0": 950, "y0": 800, "x1": 1050, "y1": 900}, (1016 - 40 - 1050, 850 - 40 - 900)),
    ],
)
def test_revealing_moves_no_farther_than_it_must(call, bounds: dict, expected: tuple[float, float]) -> None:
    body = "return m.revealing({scale: 1, x: 0, y: 0}, a.bounds, a.size)"
    view = call("geometry/view", body, {"bounds": bounds, "size": SIZE})
    assert (view["scale"], view["x"], view["y"]) == (1, *expected)


def test_revealing_zooms_in_on_a_cap_too_small_to_work_on(call) -> None:
    tiny = {"x0": 100, "y0": 100, "x1": 106, "y1": 106}
    body = "return m.revealing({scale: 0.5, x: 0, y: 0}, a.bounds, a.size)"
    view = call("geometry/view", body, {"bounds": tiny, "size": SIZE})
    assert view["scale"] * 6 > 200
    assert 0 < 103 * view["scale"] + view["x"] < 1016
