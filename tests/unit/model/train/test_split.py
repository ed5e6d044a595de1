"""Training and validation share no photo."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.train.split import split_by_source

names = st.lists(st.sampled_from([f"photo {n}" for n in range(30)]), min_size=1)


@settings(max_examples=40)
@given(names)
def test_copies_of_one_photo_fall_on_one_side(sources: list[str]) -> None:
    sides = split_by_source(sources)
    for photo in set(sources):
        assert len({side for side, source in zip(sides, sources, strict=True) if source == photo}) == 1


@settings(max_examples=40)
@given(names)
def test_the_order_of_the_items_does_not_matter(sources: list[str]) -> None:
    by_photo = dict(zip(sources, split_by_source(sources), strict=True))
    turned = sources[::-1]
    assert dict(zip(turned, split_by_source(turned), strict=True)) == by_photo


def test_seven_of_ten_photos_train() -> None:
    sources = [f"bed {n}" for n in range(480) for _ in range(4)]
    sides = split_by_source(sources)
    assert sides.count("train") == 4 * 336
    assert split_by_source(sources, seed=1) != sides


def test_a_share_outside_its_range_is_refused() -> None:
    with pytest.raises(ValueError, match="share"):
        split_by_source(["a"], share=1.5)
