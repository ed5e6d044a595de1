"""What people say of pieces of an outline holds where the outline passes by them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.model.geometry.shapes import GeometryError
from fairyring.model.geometry.told_arcs import NOT_TOLD, ToldArc, check_told_arcs, told_of_points

SQUARE = [[0.0, 0.0, 100.0, 0.0, 100.0, 100.0, 0.0, 100.0]]
TOP = ToldArc(kind="hidden", points=[20.0, 0.5, 80.0, 0.5])


def test_points_are_told_within_half_their_spacing_of_the_line_and_what_was_said_last_holds() -> None:
    points = np.array([[10.0, 0.0], [18.0, 0.0], [50.0, 0.0], [50.0, 9.0], [82.0, 1.0]])
    later = ToldArc(kind="contact", points=[50.0, 0.0])
    told = told_of_points([TOP, later], points, np.full(5, 6.0))
    assert told.tolist() == [NOT_TOLD, 1, 3, NOT_TOLD, 1]


def test_what_is_said_of_a_piece_that_is_not_there_is_dropped() -> None:
    elsewhere = ToldArc(kind="border", points=[50.0, 40.0, 50.0, 60.0])
    assert check_told_arcs([elsewhere, TOP], SQUARE) == [TOP]


@pytest.mark.parametrize("points", [[], [1.0], [1.0, math.nan], [1.0, math.inf], [0.0, 0.0] * 2001])
def test_points_that_are_none_or_far_too_many_are_refused(points: list[float]) -> None:
    with pytest.raises(GeometryError):
        check_told_arcs([ToldArc(kind="visible", points=points)], SQUARE)
