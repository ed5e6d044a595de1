"""How much further out people draw rims, told from what was found beside what was drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.predict.seen import Detection
from fairyring.model.train.data import Example
from fairyring.model.train.rims import FEWEST, LOGITS_PER_PX, MOST, fitting_rim

SIDE = 400
MIDDLES = [(40 + 60.17 * column, 40 + 60.29 * row) for row in range(6) for column in range(6)]
"""Anywhere among the pixels, so that what a mask rounds evens out."""


def drawn(radius: float, *, count: int = len(MIDDLES)) -> Example:
    caps = [[polygon_of_shape(Circle(x, y, radius))] for x, y in MIDDLES[:count]]
    return Example(path=Path("bed.png"), width=SIDE, height=SIDE, caps=caps)


def found(radius: float) -> list[Detection]:
    outlines = [[polygon_of_shape(Circle(x, y, radius))] for x, y in MIDDLES]
    return [
        Detection(score=0.9, outline=outline, rle=rle_of_outline(outline, width=SIDE, height=SIDE))
        for outline in outlines
    ]


def test_rims_drawn_further_out_ask_for_more() -> None:
    told = fitting_rim([drawn(20.4)], [found(20.0)], rim=0.1)
    assert told == pytest.approx(0.1 + 0.4 * LOGITS_PER_PX, abs=0.15)
    assert fitting_rim([drawn(20.0)], [found(20.0)], rim=0.1) == pytest.approx(0.1, abs=1e-9)
    assert fitting_rim([drawn(19.8)], [found(20.0)], rim=0.0) == pytest.approx(-0.2 * LOGITS_PER_PX, abs=0.15)


def test_it_goes_no_further_than_rims_do() -> None:
    assert fitting_rim([drawn(22.0)], [found(20.0)], rim=0.0) == MOST


def test_a_few_caps_and_caps_that_are_something_else_tell_nothing() -> None:
    assert fitting_rim([drawn(20.4, count=FEWEST - 1)], [found(20.0)], rim=0.3) == 0.3
    assert fitting_rim([drawn(20.0)], [found(12.0)], rim=0.3) == 0.3
    assert fitting_rim([drawn(20.0, count=0), drawn(20.0)], [found(20.0), []], rim=0.3) == 0.3
