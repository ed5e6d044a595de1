"""The human floor from caps that were marked twice."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.model.evaluate.repeated_marks import (
    ENOUGH,
    CapClass,
    RepeatedMark,
    floor_between,
    floor_of_repeats,
    floors_by_class,
    hands_of,
)

WIDTH, HEIGHT = 1280, 720


def of(annotator: str = "Ada", visibility: str = "95_percent_and_more") -> CapClass:
    return CapClass(annotator=annotator, size="m", shape="regular", visibility=visibility)


def marked_twice(
    sd: float, *, count: int, seed: int = 1, expected: float = 1.0, **more: str
) -> list[RepeatedMark]:
    """Caps at the same place, of which both marks are off by normal noise of ``sd`` pixels."""
    marks = np.random.default_rng(seed).normal((600, 300), sd, (count, 2, 2))
    floors = [floor_between((a, b), (c, d), width=WIDTH, height=HEIGHT) for (a, b), (c, d) in marks.tolist()]
    return [
        RepeatedMark(of=of(**more), image=nth % 12, floor=floor, expected=expected)
        for nth, floor in enumerate(floors)
    ]


def cdr_of(sd: float) -> float:
    """Mean CDR of one mark: the mean of the absolute value of normal noise is .798 of its deviation."""
    return 100 * math.sqrt(2 / math.pi) * sd * (1 / WIDTH + 1 / HEIGHT)


@pytest.mark.parametrize("sd", [0.4, 1.0, 3.0])
def test_the_floor_lies_within_15_percent_of_the_noise_put_in_and_its_interval_holds_it(sd: float) -> None:
    found = floor_of_repeats(marked_twice(sd, count=120, seed=3))
    assert found is not None
    assert found.mean == pytest.approx(cdr_of(sd), rel=0.15)
    assert found.low < cdr_of(sd) < found.high
    assert found.count == 120


def test_the_interval_holds_the_noise_put_in_about_19_times_in_20() -> None:
    found = [floor_of_repeats(marked_twice(1.0, count=60, seed=seed)) for seed in range(60)]
    held = sum(each is not None and each.low < cdr_of(1.0) < each.high for each in found)
    # Drawn from 12 images the bootstrap is a little narrow: 19 in 20 would be 57 of 60.
    assert 49 <= held <= 60


def test_people_and_kinds_of_caps_have_floors_of_their_own() -> None:
    steady, shaky = marked_twice(0.5, count=100), marked_twice(2.0, count=100, annotator="Ben")
    by = floors_by_class([*steady, *shaky])
    assert by["annotator"]["Ada"].mean == pytest.approx(cdr_of(0.5), rel=0.15)
    assert by["annotator"]["Ben"].mean == pytest.approx(cdr_of(2.0), rel=0.15)
    assert by["size"]["m"].count == 200


def test_a_floor_is_that_of_the_geometry_until_there_are_enough_repeats() -> None:
    few, many = marked_twice(1.0, count=ENOUGH - 1), marked_twice(1.0, count=ENOUGH)
    assert hands_of(few).floor(of(), 0.3) == 0.3
    ratio = sum(each.floor for each in many) / ENOUGH
    assert hands_of(many).floor(of(), 0.3) == pytest.approx(0.3 * ratio)
    assert hands_of(many).floor(of("Ben"), 0.3) == 0.3
    assert hands_of(many).floor(of(), None) is None


def test_a_class_with_enough_repeats_goes_by_its_own_others_by_all_of_the_annotator() -> None:
    hidden = marked_twice(4.0, count=200, visibility="under_60_percent", expected=cdr_of(1.0))
    hands = hands_of([*hidden, *marked_twice(1.0, count=200, expected=cdr_of(1.0))])
    floors = {name: hands.floor(of(visibility=name), 1.0) for name in ("under_60_percent", "never_seen")}
    assert floors["under_60_percent"] == pytest.approx(4.0, rel=0.15)
    assert floors["never_seen"] == pytest.approx(2.5, rel=0.15)
