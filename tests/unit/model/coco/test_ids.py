"""Ids, by value."""

from __future__ import annotations

from typing import Any

import pytest

from fairyring.model.coco.ids import id_of


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (1, 1),
        (1.0, 1),
        ("1", 1),
        ("1.0", 1),
        ("-3", -3),
        (0, 0),
        ("0", 0),
        ("bed_1", "bed_1"),
        ("", ""),
        ("1e3", "1e3"),
        (" 1", " 1"),
        (10**30, 10**30),
        (1e300, int(1e300)),
    ],
)
def test_an_id_is_a_whole_number_or_a_text(value: Any, expected: Any) -> None:
    assert id_of(value) == expected
    assert type(id_of(value)) is type(expected)


@pytest.mark.parametrize("value", [None, True, False, 1.5, float("nan"), float("inf"), [1], {"id": 1}])
def test_nothing_else_is_one(value: Any) -> None:
    assert id_of(value) is None


def test_leading_zeros_tell_two_ids_apart() -> None:
    assert id_of("007") != id_of("7")
