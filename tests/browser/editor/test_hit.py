"""Pointing at caps, checked against OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

CAP = {
    "mark": None,
    "ignored": False,
    "doubtful": False,
    "order": None,
    "category": "mushroom",
    "prediction": None,
}


def shape(uid: str, visible: list[list[float]], mark: dict | None = None) -> dict:
    cap = {**CAP, "visible": visible, "mark": mark}
    fields = {"revision": 1, "deleted": False, "whole": None, "centre": None, "score": None}
    return {"uid": uid, "cap": cap, **fields}


def star(chance: np.random.Generator, centre: np.ndarray, radius: float, count: int) -> np.ndarray:
    """A polygon with dents, which crosses itself nowhere."""
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    radii = radius * chance.uniform(0.6, 1.0, count)
    return (centre + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])).astype(np.float32)


def test_the_smallest_cap_under_the_pointer_is_picked_as_brute_force_says(call) -> None:
    chance = np.random.default_rng(3)
    rings = [star(chance, chance.uniform(0, 300, 2), chance.uniform(8, 80), 17) for _ in range(60)]
    points = chance.uniform(0, 300, (200, 2))
    shapes = [shape(str(i), [ring.ravel().astype(float).tolist()]) for i, ring in enumerate(rings)]
    body = "return a.points.map((point) => m.pick(a.shapes, point, 0)?.uid ?? null)"
    picked = call("geometry/hit", body, {"shapes": shapes, "points": points.tolist()})
    checked = 0
    for point, found in zip(points, picked, strict=True):
        distances = [cv2.pointPolygonTest(ring, point.tolist(), measureDist=True) for ring in rings]
        if min(abs(d) for d in distances) < 0.01:
            continue
        inside = [i for i, d in enumerate(distances) if d > 0]
        expected = min(inside, key=lambda i: cv2.contourArea(rings[i])) if inside else None
        assert found == (None if expected is None else str(expected))
        checked += expected is not None
    assert checked > 50


def test_a_labelled_cap_is_picked_rather_than_its_prediction_but_a_nested_prediction_is_reached(call) -> None:
    ring = [[0.0, 0.0, 40.0, 0.0, 40.0, 40.0, 0.0, 40.0]]
    inner = [[10.0, 10.0, 20.0, 10.0, 20.0, 20.0, 10.0, 20.0]]
    tight = [[1.0, 1.0, 39.0, 1.0, 39.0, 39.0, 1.0, 39.0]]
    labelled = shape("labelled", ring)
    same, nested = ({**shape(uid, part), "score": 0.9} for uid, part in (("same", tight), ("nested", inner)))
    body = "return a.points.map((point) => m.pick(a.shapes, point, 3).uid)"
    found = call("geometry/hit", body, {"shapes": [labelled, same, nested], "points": [[30, 30], [15, 15]]})
    assert found == ["labelled", "nested"]


def test_beside_every_cap_the_nearest_outline_within_reach_is_picked(call) -> None:
    left = shape("left", [[0, 0, 10, 0, 10, 10, 0, 10]])
    right = shape("right", [[20, 0, 30, 0, 30, 10, 20, 10]])
    body = "return a.points.map((point) => m.pick(a.shapes, point, 6)?.uid ?? null)"
    points = [[14, 5], [16, 5], [15, 40]]
    assert call("geometry/hit", body, {"shapes": [left, right], "points": points}) == ["left", "right", None]


def test_the_rim_of_a_bare_circle_can_be_picked_from_outside(call) -> None:
    circle = shape("c", [], {"kind": "circle", "cx": 50, "cy": 50, "r": 20})
    body = "return a.points.map((point) => m.pick([a.circle], point, 3)?.uid ?? null)"
    points = [[50, 50], [72, 50], [74, 50], [50, 28.5]]
    assert call("geometry/hit", body, {"circle": circle, "points": points}) == ["c", "c", None, "c"]


def test_a_rubber_band_selects_only_what_lies_wholly_inside(call) -> None:
    inside, across = shape("in", [[10, 10, 20, 10, 15, 20]]), shape("across", [[10, 10, 40, 10, 15, 20]])
    body = "return m.within(a, {x0: 5, y0: 5, x1: 30, y1: 30}).map(({uid}) => uid)"
    assert call("geometry/hit", body, [inside, across]) == ["in"]


def test_the_nearest_edge_is_as_far_away_as_opencv_says(call) -> None:
    chance = np.random.default_rng(5)
    ring = star(chance, np.array([60.0, 60.0]), 50, 23)
    points = chance.uniform(0, 120, (100, 2))
    cap = {**CAP, "visible": [ring.ravel().astype(float).tolist()]}
    body = "return a.points.map((point) => m.nearestEdges(a.cap, point, 1e9).foot)"
    feet = np.array(call("geometry/vertices", body, {"cap": cap, "points": points.tolist()}))
    found = np.linalg.norm(feet - points, axis=1)
    expected = [abs(cv2.pointPolygonTest(ring, point.tolist(), measureDist=True)) for point in points]
    assert found == pytest.approx(expected, abs=1e-3)


def test_the_nearest_vertex_is_found_within_reach_only(call) -> None:
    cap = {**CAP, "visible": [[0, 0, 10, 0, 10, 10, 0, 10]]}
    body = "return a.points.map((point) => m.nearestVertices(a.cap, point, 3))"
    found = call("geometry/vertices", body, {"cap": cap, "points": [[9, 1], [5, 5]]})
    assert found == [[{"ring": 0, "index": 1}], []]
