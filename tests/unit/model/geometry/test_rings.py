"""Many polygons at once say what each says by itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.rings import areas_of, bounds_of, parts_of, rings_of, rings_of_shapes
from fairyring.model.geometry.shapes import (
    Circle,
    area_of_outline,
    bounds_of_outline,
    canonical_ellipse,
    polygon_of_shape,
)

number = st.floats(-5000, 5000)
part = st.lists(number, min_size=3, max_size=12).map(lambda xs: [v for x in xs for v in (x, x * 0.3 + 1)])
shape = st.builds(Circle, number, number, st.floats(0.01, 3000)) | st.builds(
    canonical_ellipse, number, number, st.floats(0.01, 3000), st.floats(0.01, 3000), st.floats(0, 360)
)


def test_three_shapes_known_by_heart() -> None:
    square, triangle = [10.0, 10, 30, 10, 30, 30, 10, 30], [50.0, 50, 60, 50, 55, 60]
    rings = rings_of([square, triangle, [1.0, 1.0]])
    assert areas_of(rings).tolist() == [400, 50, 0]
    least, greatest = bounds_of(rings)
    assert least.tolist() == [[10, 10], [50, 50], [1, 1]]
    assert greatest.tolist() == [[30, 30], [60, 60], [1, 1]]


@settings(max_examples=60)
@given(st.lists(part, max_size=5))
def test_areas_and_bounds_are_those_of_each(parts: list[list[float]]) -> None:
    rings = rings_of(parts)
    assert parts_of(rings) == parts
    assert areas_of(rings) == pytest.approx([area_of_outline([each]) for each in parts], rel=1e-9, abs=1e-6)
    least, greatest = bounds_of(rings)
    boxes = np.hstack([least, greatest - least]).tolist()
    assert boxes == [list(bounds_of_outline([each])) for each in parts]


@settings(max_examples=60)
@given(st.lists(shape, max_size=5))
def test_shapes_have_the_vertices_that_each_has(shapes: list) -> None:
    found = parts_of(rings_of_shapes(shapes))
    expected = [polygon_of_shape(each) for each in shapes]
    assert [len(each) for each in found] == [len(each) for each in expected]
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1e-12, abs=1e-9)
