"""Changing outlines by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

SQUARE = [0, 0, 100, 0, 100, 100, 0, 100]
CAP = {
    "mark": None,
    "ignored": False,
    "doubtful": False,
    "order": None,
    "category": "mushroom",
    "prediction": None,
}


def cap(visible: list[float], mark: dict | None = None) -> dict:
    return {**CAP, "visible": [visible], "mark": mark}


def test_dragging_a_vertex_of_a_sparse_outline_moves_it_alone(call) -> None:
    body = "return m.draggedVertices(a, [{ring: 0, index: 1}], {dx: 5, dy: -3, pull: 16})"
    assert call("geometry/vertices", body, cap(SQUARE))["visible"] == [[0, 0, 105, -3, 100, 100, 0, 100]]


def test_a_dense_outline_follows_the_vertex_that_is_dragged(call) -> None:
    line = [value for x in range(40) for value in (x, 0)] + [20, 200]
    body = "return m.draggedVertices(a, [{ring: 0, index: 20}], {dx: 0, dy: 8, pull: 10})"
    moved = np.array(call("geometry/vertices", body, cap(line))["visible"][0]).reshape(-1, 2)
    for x in range(40):
        along = abs(x - 20)
        expected = 8 * math.cos(math.pi * along / 20) ** 2 if along < 10 else 0
        assert moved[x] == pytest.approx([x, expected])


def test_a_mark_taken_from_the_outline_moves_with_it(call) -> None:
    mark = {"kind": "polygon", "points": SQUARE}
    body = """
      const found = m.nearestVertices(a, [101, 1], 5);
      return [found, m.draggedVertices(a, found, {dx: 1, dy: 2, pull: 0})];
    """
    found, moved = call("geometry/vertices", body, cap(SQUARE, mark))
    assert found == [{"ring": 0, "index": 1}, {"ring": 1, "index": 1}]
    assert moved["visible"][0] == moved["mark"]["points"] == [0, 0, 101, 2, 100, 100, 0, 100]


def test_a_press_on_an_edge_puts_a_vertex_there(call) -> None:
    body = """
      const {edges, foot} = m.nearestEdges(a, [102, 40], 6);
      return m.insertedVertices(a, edges, foot);
    """
    found = call("geometry/vertices", body, cap(SQUARE))
    assert found["vertices"] == [{"ring": 0, "index": 2}]
    assert found["cap"]["visible"] == [[0, 0, 100, 0, 100, 40, 100, 100, 0, 100]]


def test_the_edge_that_closes_the_outline_is_an_edge_too(call) -> None:
    body = """
      const {edges, foot} = m.nearestEdges(a, [-1, 50], 6);
      return m.insertedVertices(a, edges, foot).cap.visible;
    """
    assert call("geometry/vertices", body, cap(SQUARE)) == [[*SQUARE, 0, 50]]


def test_an_outline_never_falls_below_three_vertices(call) -> None:
    body = """
      const once = m.removedVertices(a, [{ring: 0, index: 0}]);
      return [once.visible, m.removedVertices(once, [{ring: 0, index: 0}])];
    """
    assert call("geometry/vertices", body, cap(SQUARE)) == [[[100, 0, 100, 100, 0, 100]], None]


def test_changing_a_cap_leaves_the_one_it_came_from_alone(call) -> None:
    body = """
      const before = JSON.stringify(a);
      m.draggedVertices(a, [{ring: 0, index: 1}], {dx: 5, dy: 5, pull: 300});
      m.removedVertices(a, [{ring: 0, index: 1}]);
      m.insertedVertices(a, [{ring: 0, index: 1}], [1, 1]);
      return before === JSON.stringify(a);
    """
    assert call("geometry/vertices", body, cap(SQUARE))


def test_dragging_the_rim_changes_the_radius_by_what_the_pointer_moved_outwards(call) -> None:
    circle = {**CAP, "visible": [], "mark": {"kind": "circle", "cx": 50, "cy": 50, "r": 20}}
    body = """
      const handle = m.nearestHandle(a, [50, 71], 5);
      return [handle.kind, m.movedHandle(a, handle, {dx: 0, dy: 6, from: [50, 71], pull: 16}).mark];
    """
    assert call("geometry/handles", body, circle) == ["rim", {"kind": "circle", "cx": 50, "cy": 50, "r": 26}]


def test_dragging_the_centre_handle_moves_the_mark_and_not_the_outline(call) -> None:
    marked = cap(SQUARE, {"kind": "circle", "cx": 50, "cy": 50, "r": 20})
    body = """
      const handle = m.nearestHandle(a, [51, 51], 5);
      return [handle.kind, m.movedHandle(a, handle, {dx: 0.25, dy: -1, from: [51, 51], pull: 16})];
    """
    kind, moved = call("geometry/handles", body, marked)
    assert kind == "centre"
    assert moved["mark"] == {"kind": "circle", "cx": 50.25, "cy": 49, "r": 20}
    assert moved["visible"] == [SQUARE]


@pytest.mark.parametrize("radius", [3.0, 40.0, 900.0])
def test_a_circle_as_polygon_keeps_its_centre_and_errs_by_a_tenth_of_a_pixel_at_most(
    call, radius: float
) -> None:
    circle = {"kind": "circle", "cx": 123.25, "cy": 77.5, "r": radius}
    points = np.array(call("geometry/caps", "return m.polygonOfCircle(a)", circle)).reshape(-1, 2)
    middles = (points + np.roll(points, -1, axis=0)) / 2
    assert points.mean(axis=0) == pytest.approx([123.25, 77.5], abs=1e-9)
    assert np.linalg.norm(points - [123.25, 77.5], axis=1) == pytest.approx(radius)
    assert radius - np.linalg.norm(middles - [123.25, 77.5], axis=1).min() <= 0.1


def test_the_bounds_of_an_ellipse_are_those_of_its_points(call) -> None:
    angle, t = math.radians(33), np.linspace(0, 2 * np.pi, 100_001)
    x = 10 + 40 * np.cos(t) * math.cos(angle) - 15 * np.sin(t) * math.sin(angle)
    y = 20 + 40 * np.cos(t) * math.sin(angle) + 15 * np.sin(t) * math.cos(angle)
    ellipse = {"kind": "ellipse", "cx": 10, "cy": 20, "a": 40, "b": 15, "theta_deg": 33}
    bounds = call("geometry/caps", "return m.boundsOfWhole(a)", ellipse)
    expected = [x.min(), y.min(), x.max(), y.max()]
    assert [bounds["x0"], bounds["y0"], bounds["x1"], bounds["y1"]] == pytest.approx(expected, abs=1e-6)


def test_handles_keep_their_distance_along_the_outline(call) -> None:
    line = [value for x in range(101) for value in (x, 0)]
    assert call("geometry/vertices", "return m.spacedVertices(a, 10)", line) == list(range(0, 101, 10))
