"""The figures of ``evaluate masks`` apart for small caps, for each size, light and form."""

from __future__ import annotations

import pytest

from fairyring.model.evaluate.masks import score_masks
from tests.support.squares import cap, page, scores


def test_caps_under_30_px_count_apart_from_the_success_rate() -> None:
    # The circle of 26 × 26 px measures 29.3 px, of 27 × 27 px 30.5.
    truths = [cap(0, 0), cap(100, 0, 26, 26), cap(200, 0, 26, 26), cap(300, 0, 27, 27)]

    found = scores(truths, [cap(0, 0), cap(100, 0, 26, 26)])

    assert (found.s50, found.s75, found.s50_small) == (0.5, 0.5, 0.5)
    assert (found.p, found.r) == (1, 0.5)
    assert (found.counts.small, found.groups["size"]["under_30_px"].count) == (2, 2)
    assert (found.groups["size"]["s"].count, found.groups["size"]["m"].count) == (1, 1)


def test_a_large_cap_of_which_little_is_seen_is_not_small() -> None:
    seen = scores([cap(0, 0, 20, 20, diameter=30.0)], [])
    assert (seen.s50, seen.s50_small) == (0, None)

    small = scores([cap(0, 0, 40, 40, diameter=29.9)], [])
    assert (small.s50, small.s50_small) == (None, 0)


def test_sizes_are_coco_s_classes_by_visible_area() -> None:
    truths = [cap(0, 0, 32, 31), cap(50, 0, 32, 32), cap(100, 0, 96, 95), cap(200, 0, 96, 96)]

    sizes = scores(truths, [truths[1], truths[3]]).groups["size"]

    assert [(sizes[name].count, sizes[name].s50) for name in "sml"] == [(1, 0), (2, 0.5), (1, 1)]
    assert sizes["under_30_px"].count == 0
    assert sizes["l"].ap == 1


def test_light_and_form_are_those_of_the_images_that_state_them() -> None:
    found = score_masks(
        [
            page([cap(0, 0), cap(100, 0)], [cap(0, 0)], light="top", form="a"),
            page([cap(0, 0)], [cap(0, 0), cap(5, 0)], light="top", form="b", file_name="b.png"),
            page([cap(0, 0), cap(100, 0, 20, 20)], [], light="dark", file_name="c.png"),
        ]
    )

    groups = found.groups
    assert list(groups) == ["light", "form", "size"]
    assert set(groups["light"]) == {"top", "dark"}
    assert set(groups["form"]) == {"a", "b"}
    top, dark = groups["light"]["top"], groups["light"]["dark"]
    assert (top.count, top.s50, top.s75, top.s50_strict) == (3, 2 / 3, 2 / 3, 1 / 3)
    # Perfect up to recall 2/3, then nothing.
    assert top.ap == pytest.approx(67 / 101)
    assert (dark.count, dark.s50, dark.ap) == (1, 0, 0)
