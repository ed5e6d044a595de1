"""Which cells learn which cap: drawn examples, and a loop over every cell."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.network.config import LIGHT_RANGES, NetworkConfig
from fairyring.model.network.targets import EMPTY, IGNORED, assign_cells, grid_shape

CONFIG = NetworkConfig(reduction=1, grids=(80, 64, 32, 16, 12), scale_ranges=LIGHT_RANGES)
"""Cells of 16, 20, 40, 80 and 106.7 pixels."""
EVERYWHERE = replace(CONFIG, scale_ranges=((1, 10_000),) * 5)


def cells_with(level: NDArray[np.int64], value: int) -> set[tuple[int, int]]:
    """Row, column."""
    return {(int(row), int(column)) for row, column in np.argwhere(level == value)}


def test_a_drawn_cap_is_learnt_where_its_middle_fifth_lies() -> None:
    # 40 px wide: levels of 1…56 and 28…112. Middle fifth: x 62…70, y 55…63.
    levels = assign_cells(
        np.array([[46.0, 39, 40, 40]]), np.array([[66.0, 59]]), CONFIG, height=128, width=128
    )
    assert [level.shape for level in levels] == [(8, 8), (6, 6), (3, 3), (2, 2), (1, 1)]
    assert cells_with(levels[0], 0) == {(3, 3), (3, 4)}
    # Cells of 128 / 6 = 21.3 px.
    assert cells_with(levels[1], 0) == {(2, 2), (2, 3)}
    assert all((level == EMPTY).all() for level in levels[2:])


def test_scale_ranges_include_their_ends_and_are_of_network_pixels() -> None:
    centre = np.array([[200.0, 200]])

    def levels_of(side: float, config: NetworkConfig) -> list[int]:
        levels = assign_cells(np.array([[100, 100, side, side]]), centre, config, height=512, width=512)
        return [nth for nth, level in enumerate(levels) if (level == 0).any()]

    assert levels_of(28, CONFIG) == [0, 1]
    assert levels_of(27, CONFIG) == [0]
    assert levels_of(56, CONFIG) == [0, 1, 2]
    assert levels_of(57, CONFIG) == [1, 2]
    assert levels_of(56, replace(CONFIG, reduction=2)) == [0, 1]
    assert levels_of(112, replace(CONFIG, reduction=2)) == [0, 1, 2]


def test_the_scale_is_that_of_the_boxs_area() -> None:
    levels = assign_cells(
        np.array([[0, 0, 100.0, 25.0]]), np.array([[64.0, 64]]), CONFIG, height=128, width=128
    )
    assert [(level == 0).any() for level in levels] == [True, True, False, False, False]


def test_a_large_cap_reaches_one_cell_from_its_centre() -> None:
    levels = assign_cells(
        np.array([[20.0, 318, 600, 4]]), np.array([[324.0, 324]]), EVERYWHERE, height=640, width=640
    )
    assert cells_with(levels[0], 0) == {(20, 19), (20, 20), (20, 21)}


def test_of_two_caps_in_one_cell_the_one_nearer_to_its_middle_has_it() -> None:
    boxes = np.array([[30.0, 30, 10, 10], [34.0, 34, 10, 10]])
    centres = np.array([[34.0, 35.0], [39.0, 39.5]])
    for order in ([0, 1], [1, 0]):
        levels = assign_cells(boxes[order], centres[order], CONFIG, height=128, width=128)
        # The cell of 32…48 has its middle at 40.
        assert cells_with(levels[0], order.index(1)) == {(2, 2)}
        assert not cells_with(levels[0], order.index(0))


def test_ignored_cells_learn_nothing_unless_a_cap_is_there() -> None:
    ignored = np.zeros((128, 128), bool)
    ignored[:, :64] = True
    levels = assign_cells(
        np.array([[30.0, 30, 10, 10]]), np.array([[36.0, 36]]), CONFIG, height=128, width=128, ignored=ignored
    )
    assert cells_with(levels[0], 0) == {(2, 2)}
    expected = {(row, column) for row in range(8) for column in range(4)} - {(2, 2)}
    assert cells_with(levels[0], IGNORED) == expected
    assert cells_with(levels[3], IGNORED) == {(0, 0), (1, 0)}


def test_without_caps_nothing_is_positive() -> None:
    levels = assign_cells(np.zeros((0, 4)), np.zeros((0, 2)), CONFIG, height=64, width=64)
    assert all((level == EMPTY).all() for level in levels)


def test_grids_fit_the_input_whatever_its_shape() -> None:
    assert [grid_shape(CONFIG, level, height=720, width=1280) for level in range(5)] == [
        (45, 80),
        (36, 64),
        (18, 32),
        (9, 16),
        (7, 12),
    ]
    assert grid_shape(CONFIG, 0, height=96, width=160) == (6, 10)
    assert grid_shape(CONFIG, 4, height=32, width=32) == (1, 1)


caps = st.lists(
    st.tuples(
        st.floats(0.5, 159.5),
        st.floats(0.5, 95.5),
        st.integers(1, 300),
        st.integers(1, 300),
    ),
    max_size=6,
)


@settings(max_examples=60)
@given(caps)
def test_cells_are_those_a_loop_finds(drawn: list[tuple[float, float, int, int]]) -> None:
    """Each cell asks every cap of its scale whether it is touched, and takes the nearest."""
    boxes = np.array([(0.0, 0.0, w, h) for _, _, w, h in drawn]).reshape(-1, 4)
    centres = np.array([(x, y) for x, y, _, _ in drawn]).reshape(-1, 2)
    levels = assign_cells(boxes, centres, CONFIG, height=96, width=160)
    for (low, high), level in zip(LIGHT_RANGES, levels, strict=True):
        rows, columns = level.shape
        wide, tall = 160 / columns, 96 / rows
        for row in range(rows):
            for column in range(columns):
                claims = []
                for cap, (x, y, w, h) in enumerate(drawn):
                    if not low <= math.sqrt(w * h) <= high:
                        continue
                    across = math.floor((x - 0.1 * w) / wide) <= column <= math.floor((x + 0.1 * w) / wide)
                    down = math.floor((y - 0.1 * h) / tall) <= row <= math.floor((y + 0.1 * h) / tall)
                    near = max(abs(column - math.floor(x / wide)), abs(row - math.floor(y / tall))) <= 1
                    if across and down and near:
                        claims.append((math.hypot(column + 0.5 - x / wide, row + 0.5 - y / tall), cap))
                found = int(level[row, column])
                if found == EMPTY:
                    assert not claims
                else:
                    nearest = min(claims)[0]
                    assert any(c == found and d <= nearest + 1e-9 for d, c in claims)
