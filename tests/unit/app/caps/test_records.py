"""Marks that hardly determine their centre are known as such, whatever makes them so."""

from __future__ import annotations

import math

import pytest

from fairyring.app.caps.records import is_unsure
from fairyring.model.contour.marks import reconstruction_of_mark
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon
from fairyring.storage.records import Annotation, Cap, Mark


def arc(degrees: float, *, count: int, again: int = 1) -> Polygon:
    """Points on so much of the rim of a circle of 40 px, each clicked so many times."""
    turns = [math.radians(degrees * nth / count) for nth in range(count) for _ in range(again)]
    return Polygon([value for t in turns for value in (100 + 40 * math.cos(t), 100 + 40 * math.sin(t))])


def marked(mark: Mark) -> Annotation:
    fit = reconstruction_of_mark(mark).fit
    cap = Cap(visible=[], mark=mark)
    return Annotation(
        uid="a", image=1, revision=1, cap=cap, whole=fit.whole, centre=fit.centre, centre_sd=fit.centre_sd
    )


@pytest.mark.parametrize(
    "mark",
    [
        arc(57, count=12),
        arc(110, count=4),
        arc(60, count=3, again=6),
        Ellipse(100.0, 100.0, 60.0, 6.0, 0.0),
    ],
    ids=["a short arc", "few points", "the same points again", "an impossible ellipse"],
)
def test_they_are_unsure(mark: Mark) -> None:
    assert is_unsure(marked(mark))


SURE = (arc(360, count=12), Circle(100.0, 100.0, 40.0), Ellipse(9.0, 9.0, 5.0, 4.0, 0.0))


@pytest.mark.parametrize("mark", SURE)
def test_others_are_not_nor_is_a_cap_that_nobody_marked(mark: Mark) -> None:
    assert not is_unsure(marked(mark))
    assert not is_unsure(Annotation(uid="a", image=1, revision=1, cap=Cap(visible=[])))
