"""Groups of caps stand in an order in which one finds them."""

from __future__ import annotations

import random

import pytest

from fairyring.app.review.groups import in_order


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("size", ["s", "m", "l", "under_30_px", "not_known"]),
        ("visibility", ["95_percent_and_more", "60_to_95_percent", "under_60_percent"]),
        ("light", ["top", "side", "dark", "not_known"]),
        ("form", ["a", "b", "h"]),
    ],
)
def test_what_has_an_order_of_its_own_keeps_it(kind: str, values: list[str]) -> None:
    shuffled = random.Random(3).sample(values, len(values))
    assert [*in_order(kind, dict.fromkeys(shuffled, 1.0), cdr=lambda mean: mean)] == values


def test_people_stand_worst_first_and_those_without_a_figure_last() -> None:
    means = {"Ada": 0.3, "Ben": None, "Cid": 0.7, "not_known": 2.0}
    assert [*in_order("annotator", means, cdr=lambda mean: mean)] == ["Cid", "Ada", "Ben", "not_known"]
