"""Bars with their names below them, and round numbers at the axis."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import pytest

from fairyring.app.report.bars import IN_A_ROW, MOST_ROWS, Bar, cdr_bars, round_numbers, rows_of_bars
from fairyring.app.report.drawing import file_of
from fairyring.app.report.plots import SIDE, shifts


def bars(names: list[str]) -> str:
    measured = [Bar(name=name, cdr=0.4, floor=0.2) for name in names]
    return cdr_bars(measured, what="CDR", others="the table").html


@pytest.mark.parametrize(
    ("top", "numbers"),
    [(1.0, [0, 0.2, 0.4, 0.6, 0.8, 1.0]), (0.33, [0, 0.1, 0.2, 0.3]), (7.2, [0, 2, 4, 6]), (12, [0, 5, 10])],
)
def test_an_axis_has_round_numbers(top: float, numbers: list[float]) -> None:
    assert round_numbers(top, most=5) == numbers


@pytest.mark.parametrize("count", [1, 5, IN_A_ROW])
def test_every_bar_has_its_name_and_none_lies_on_the_next(count: int) -> None:
    names = [f"a_rather_long_name_{nth:03}.jpg" for nth in range(count)]
    html = bars(names)
    assert re.findall(r">([^<]+)</text>", html)[-count:] == names
    places = [float(x) for x in re.findall(r'<text x="([\d.]+)"[^>]*class="name', html)]
    # Upright letters are as wide as they are high.
    assert all(after - before > 10.3 for before, after in pairwise(places))


def test_short_names_lie_and_long_ones_stand_and_lose_their_middle() -> None:
    assert "rotate" not in bars(["cap 1", "cap 2"])
    html = bars(["x" * 30 + "first.jpg", "y" * 40])
    assert html.count("rotate(-90") == 2
    assert "…xxxxxfirst.jpg" in html


def test_the_300_caps_of_a_dense_bed_stand_in_five_rows_of_one_scale_with_all_their_names() -> None:
    names = [f"cap {nth}" for nth in range(1, 301)]
    html = bars(names)
    assert html.count("<svg") == 5
    assert re.findall(r"<title>(cap \d+):", html) == names
    assert {svg.count("<title>") for svg in html.split("</svg>")[:-1]} == {60}
    assert "The other" not in html
    # 0.4 of 0.42 in all rows: a bar is as high in each.
    assert len(set(re.findall(r'<rect [^>]*height="([\d.]+)"', html))) == 1


def test_of_more_bars_than_have_room_the_caption_says_how_many_others_there_are_and_where() -> None:
    assert " The other 3 stand in the table." in bars(["bar"] * (IN_A_ROW * MOST_ROWS + 3))


def test_rows_of_bars_are_kept_below_each_other_in_one_file() -> None:
    rows = rows_of_bars([Bar(name=f"cap {nth}", cdr=0.4, floor=None) for nth in range(100)], what="CDR")
    file = file_of(rows, "rect { fill: red; }")
    high = [each.height for each in rows]
    assert f'viewBox="0 0 720 {sum(high)}"' in file
    assert re.findall(r' y="(\d+)" role', file) == ["0", str(high[0])]
    assert 'viewBox="0 0 0 0"' in file_of([], "")


def test_the_ellipse_of_shifts_lies_within_its_frame() -> None:
    # Two far ones among many: they widen the ellipse, and lie beyond the edges themselves.
    html = shifts([(0.1 * nth, -0.05 * nth) for nth in range(100)] + [(60.0, 40.0), (55.0, -70.0)]).html
    drawn = re.search(
        r'<ellipse cx="([\d.]+)" cy="([\d.]+)" rx="([\d.]+)" ry="([\d.]+)"[^>]*rotate\(([-\d.]+)', html
    )
    assert drawn is not None
    x, y, along, across, degrees = map(float, drawn.groups())
    turn = math.radians(degrees)
    wide = math.hypot(along * math.cos(turn), across * math.sin(turn))
    tall = math.hypot(along * math.sin(turn), across * math.cos(turn))
    assert wide <= min(x, SIDE - x)
    assert tall <= min(y, SIDE - y)
    assert "2 lie further out." in html


def test_shifts_that_are_all_within_the_frame_and_one_that_is_not_are_told_as_such() -> None:
    even = [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] * 250
    assert "further out" not in shifts(even).html
    assert " 1 lies further out." in shifts([*even, (9.0, 0.0)]).html
