"""Pieces of large photos."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.predict.tiles import LONGEST, OVERLAP, SHORTEST, tiles_of

extents = st.integers(1, 9000)


@settings(max_examples=80)
@given(extents, extents, st.floats(0, 1), st.floats(0, 1))
def test_every_point_of_a_photo_is_one_tiles_own(width: int, height: int, across: float, down: float) -> None:
    x, y = across * width, down * height
    assert sum(tile.owns(x, y) for tile in tiles_of(width, height)) == 1


@settings(max_examples=80)
@given(extents, extents)
def test_seams_belong_to_one_tile(width: int, height: int) -> None:
    tiles = tiles_of(width, height)
    for x in {tile.own[2] for tile in tiles if np.isfinite(tile.own[2])}:
        for y in {tile.own[3] for tile in tiles if np.isfinite(tile.own[3])} | {height / 2}:
            assert sum(tile.owns(x, y) for tile in tiles) == 1


@settings(max_examples=80)
@given(extents, extents)
def test_tiles_lie_in_the_photo_and_are_of_one_size(width: int, height: int) -> None:
    tiles = tiles_of(width, height)
    across, down = (LONGEST, SHORTEST) if width >= height else (SHORTEST, LONGEST)
    ((columns, rows),) = {(tile.width, tile.height) for tile in tiles}
    assert columns <= min(width, across)
    assert rows <= min(height, down)
    for tile in tiles:
        assert 0 <= tile.x <= width - tile.width
        assert 0 <= tile.y <= height - tile.height


@settings(max_examples=150)
@given(extents, extents, st.tuples(*[st.floats(0.01, 1)] * 3), st.integers(32, OVERLAP))
def test_a_cap_up_to_the_overlap_is_whole_in_its_own_tile(
    width: int, height: int, shares: tuple[float, float, float], overlap: int
) -> None:
    x, y, r = shares[0] * width, shares[1] * height, shares[2] * overlap / 2
    (tile,) = [tile for tile in tiles_of(width, height, overlap=overlap) if tile.owns(x, y)]
    # What the photo itself cuts off is no loss of the tile's.
    assert tile.x <= max(0, x - r)
    assert tile.y <= max(0, y - r)
    assert tile.x + tile.width >= min(width, x + r)
    assert tile.y + tile.height >= min(height, y + r)


def test_a_small_photo_is_one_piece() -> None:
    (tile,) = tiles_of(700, 500)
    assert (tile.x, tile.y, tile.width, tile.height) == (0, 0, 700, 500)
    assert tile.owns(-5.0, 1e9)


def test_a_photo_of_the_usual_size_is_one_piece_and_one_twice_as_wide_three() -> None:
    assert len(tiles_of(1280, 720)) == len(tiles_of(720, 1280)) == 1
    assert len(tiles_of(1920, 1080)) == len(tiles_of(1080, 1920)) == 4
    left, middle, right = tiles_of(2560, 720)
    assert (left.x, left.y, left.width, left.height) == (0, 0, 1024, 720)
    assert (middle.x, right.x) == (768, 1536)
    assert left.own[2] == middle.own[0] == 896


def test_an_enlarged_photo_is_cut_into_pieces_no_larger_than_they_must_be() -> None:
    pieces = tiles_of(1920, 1080, overlap=116)
    assert {(piece.width, piece.height) for piece in pieces} == {(1024, 640)}
    assert [(piece.x, piece.y) for piece in pieces] == [(0, 0), (896, 0), (0, 440), (896, 440)]


def test_no_more_tiles_than_needed() -> None:
    assert len(tiles_of(LONGEST + 1, 100)) == 2
    assert len(tiles_of(2 * LONGEST - OVERLAP, 100)) == 2
    assert len(tiles_of(2 * LONGEST - OVERLAP + 1, 100)) == 3
    assert [tile.own for tile in tiles_of(2 * LONGEST - OVERLAP, 100)] == [
        (float("-inf"), float("-inf"), 1152.0, float("inf")),
        (1152.0, float("-inf"), float("inf"), float("inf")),
    ]


def test_slack_widens_what_is_owned_on_every_side() -> None:
    left, right = tiles_of(2 * LONGEST - OVERLAP, 100)
    assert [left.owns(x, 50, slack=8.0) for x in (1100, 1159.9, 1160)] == [True, True, False]
    assert [right.owns(x, 50, slack=8.0) for x in (1143.9, 1144, 2200)] == [False, True, True]
