"""Caps that were seen in several pieces and passes."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from fairyring.model.predict.overlaps import Window
from fairyring.model.predict.passes import Pass
from fairyring.model.predict.pooling import Piece, pooled
from fairyring.model.predict.tiles import tiles_of

WIDTH, HEIGHT = 200, 120
PLAIN, CLOSE = Pass(least=20), Pass(enlarged=1.5, most=40)


def disc(cx: float, cy: float, r: float) -> Window:
    """A window around a disc, its edge where the logits are 0."""
    left, top, side = int(cx - r) - 3, int(cy - r) - 3, int(2 * r) + 7
    y, x = np.mgrid[:side, :side] + 0.5
    return Window(x=left, y=top, logits=(r - np.hypot(x + left - cx, y + top - cy)).astype(np.float32))


def piece(seen_in: Pass, *seen: tuple[float, Window]) -> Piece:
    (tile,) = tiles_of(round(WIDTH * seen_in.enlarged), round(HEIGHT * seen_in.enlarged))
    scores, windows = [s for s, _ in seen], [w for _, w in seen]
    kernels = torch.zeros(len(seen), 1)
    return Piece(seen_in=seen_in, tile=tile, scores=scores, windows=windows, kernels=kernels)


def widths(*pieces: Piece) -> list[tuple[float, int]]:
    """Score and width of what is left."""
    found = pooled(pieces, width=WIDTH, height=HEIGHT)
    return [(one.score, int((one.window.logits > 0).any(axis=0).sum())) for one in found]


def test_a_cap_of_both_passes_is_there_once_and_as_sure_as_the_surer() -> None:
    plain, close = disc(100, 60, 15), disc(150, 90, 22.5)
    assert widths(piece(PLAIN, (0.9, plain)), piece(CLOSE, (0.8, close))) == [(0.9, 30)]
    assert widths(piece(PLAIN, (0.7, plain)), piece(CLOSE, (0.8, close))) == [(0.8, 30)]


def test_its_rim_lies_where_the_mean_of_both_passes_has_it() -> None:
    """At d from the middle one says 15 - d, the other 1.5 (17 - d): 0 at 16.2 if both weigh the same."""
    plain, close = disc(100, 60, 15), disc(150, 90, 1.5 * 17)
    assert widths(piece(PLAIN, (0.8, plain)), piece(CLOSE, (0.8, close))) == [(0.8, 32)]
    assert widths(piece(PLAIN, (0.8, plain)), piece(CLOSE, (0.1, close))) == [(0.8, 30)]


def test_how_well_two_passes_agree_is_the_iou_of_what_they_saw() -> None:
    both = pooled(
        [piece(PLAIN, (0.9, disc(100, 60, 15))), piece(CLOSE, (0.8, disc(150, 90, 1.5 * 17)))],
        width=WIDTH,
        height=HEIGHT,
    )
    assert [one.agreement for one in both] == [pytest.approx(15**2 / 17**2, abs=0.02)]
    alone = pooled([piece(PLAIN, (0.9, disc(100, 60, 15))), piece(CLOSE)], width=WIDTH, height=HEIGHT)
    assert [one.agreement for one in alone] == [None]


def test_where_two_passes_differ_too_much_the_surer_is_believed() -> None:
    plain, twice = disc(100, 60, 13), disc(150, 90, 1.5 * 18)
    assert widths(piece(PLAIN, (0.9, plain)), piece(CLOSE, (0.8, twice))) == [(0.9, 26)]


def test_caps_that_a_pass_is_not_for_are_not_taken_from_it() -> None:
    bud, large = disc(100, 60, 8), disc(150, 90, 45)
    assert widths(piece(PLAIN, (0.9, bud)), piece(CLOSE, (0.8, large))) == []


def test_a_small_cap_on_a_large_one_is_no_repeat_if_it_was_seen_beside_it() -> None:
    """One pass saw both and told them apart; where two passes differ, the surer is believed."""
    large, small = disc(60, 60, 40), disc(60, 60, 12)
    assert len(widths(piece(PLAIN, (0.9, large), (0.8, small)))) == 2
    assert widths(piece(PLAIN, (0.9, large)), piece(CLOSE, (0.8, disc(90, 90, 18)))) == [(0.9, 80)]


def test_what_is_hardly_a_cap_takes_the_place_of_none() -> None:
    unsure, cap = disc(100, 60, 15), disc(150, 90, 22.5)
    assert len(widths(piece(PLAIN, (0.25, unsure)), piece(CLOSE, (0.2, cap)))) == 2


def test_nothing_seen_is_nothing_told() -> None:
    assert pooled([], width=WIDTH, height=HEIGHT) == []
    assert widths(piece(PLAIN), piece(CLOSE)) == []


def test_rims_move_out_against_the_ground_and_stay_where_caps_share_them() -> None:
    """A pixel for one added to the logits, as those of discs rise by one a pixel."""
    seen = piece(PLAIN, (0.9, disc(60, 60, 21)), (0.9, disc(100, 60, 21)))
    for rim in (0.0, 1.0):
        left, right = pooled([seen], width=WIDTH, height=HEIGHT, rim=rim)
        rows = [(one.window.x + np.flatnonzero((one.window.logits > 0).any(axis=0))) for one in (left, right)]
        assert (rows[0].min(), rows[1].max()) == (39 - rim, 120 + rim)
        assert (rows[0].max(), rows[1].min()) == (79, 80)
