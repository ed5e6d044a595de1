"""One image, many doors: all caps, some, one with another outline, in any order, all to the last digit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
import pytest

from fairyring.model.contour.fitted_image import FittedImage, fitted_image
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.statistics import Statistics
from fairyring.model.scene.clusters import Recipe, make_cluster

WIDTH, HEIGHT = 640, 480


def bed(seed: int, *, count: int = 40) -> list[Silhouette]:
    """Touching and overlapping caps with noisy masks."""
    recipe = Recipe(width=WIDTH, height=HEIGHT, count=count, noise=1.0)
    return [Silhouette(cap.mask, cap.left, cap.top) for cap in make_cluster(seed=seed, recipe=recipe).caps]


def fitted(caps: Sequence[Silhouette], statistics: Statistics | None = None) -> FittedImage:
    return fitted_image(caps, width=WIDTH, height=HEIGHT, statistics=statistics)


def moved(cap: Silhouette, *, x: int = 0, y: int = 0) -> Silhouette:
    return Silhouette(cap.mask, cap.left + x, cap.top + y)


def facts(found: Reconstruction) -> list[object]:
    """Everything about it, arcs as lists, to be compared for equality."""
    arcs = [(arc.kind, arc.points.tolist(), arc.neighbour) for arc in found.arcs]
    return [arcs, *(getattr(found, field.name) for field in fields(found) if field.name != "arcs")]


def agree(found: Sequence[Reconstruction], expected: Sequence[Reconstruction]) -> bool:
    """Whether they are equal to the last digit."""
    return [facts(each) for each in found] == [facts(each) for each in expected]


def rightmost(caps: Sequence[Silhouette]) -> Silhouette:
    return max(caps, key=lambda cap: cap.left)


def distance(cap: Silhouette, other: Silhouette) -> float:
    middles = [np.add(each.box[:2], each.box[2:]) / 2 for each in (cap, other)]
    return float(np.hypot(*(middles[0] - middles[1])))


@pytest.mark.parametrize("seed", [1, 2])
def test_one_cap_at_a_time_says_what_all_at_once_say(seed: int):
    caps = bed(seed)
    everything = fitted(caps).reconstructions(caps)
    image = fitted(caps)
    assert agree([image.reconstructions([cap])[0] for cap in reversed(caps)][::-1], everything)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_order_in_which_caps_come_does_not_matter(seed: int):
    caps = bed(seed)
    shuffled = [caps[at] for at in np.random.default_rng(seed).permutation(len(caps))]
    assert agree(fitted(shuffled).reconstructions(caps), fitted(caps).reconstructions(caps))


@pytest.mark.parametrize("at", [0, 7, 23])
def test_one_cap_with_another_outline_is_what_fitting_the_whole_image_with_it_gives(at: int):
    caps = bed(3)
    image = fitted(caps)
    image.reconstructions(caps)
    changed = [*caps[:at], moved(caps[at], x=3, y=-2), *caps[at + 1 :]]
    expected = fitted(changed, image.statistics).reconstructions(changed)
    assert agree(image.with_caps(changed).reconstructions([changed[at]]), [expected[at]])
    assert agree(image.with_caps(changed).reconstructions(changed), expected)


def test_a_row_of_changes_ends_where_a_fresh_start_does():
    caps = bed(4)
    image = fitted(caps)
    statistics = image.statistics
    random = np.random.default_rng(4)
    for _ in range(12):
        at = int(random.integers(len(caps)))
        change = int(random.integers(3))
        if change == 0:
            caps = [*caps[:at], moved(caps[at], x=int(random.integers(-4, 5))), *caps[at + 1 :]]
        elif change == 1:
            caps = [*caps[:at], *caps[at + 1 :]]
        else:
            caps = [*caps, moved(caps[at], y=int(random.integers(20, 60)))]
        image = image.with_caps(caps)
        image.reconstructions(caps[:2])
    assert agree(image.reconstructions(caps), fitted(caps, statistics).reconstructions(caps))


def test_a_moved_neighbour_changes_a_fit_and_a_far_cap_does_not():
    caps = bed(5)
    image = fitted(caps)
    cap = caps[0]
    before = image.reconstructions([cap])
    touching = [arc.neighbour for arc in before[0].arcs if arc.neighbour is not None]
    neighbour = touching[0]
    far = max(caps, key=lambda other: distance(cap, other))
    with_neighbour = image.with_caps([moved(c, x=4) if c is neighbour else c for c in caps])
    with_far = image.with_caps([moved(c, x=1) if c is far else c for c in caps])
    assert not agree(with_neighbour.reconstructions([cap]), before)
    assert agree(with_far.reconstructions([cap]), before)


def test_the_same_caps_are_the_same_image():
    caps = bed(6, count=12)
    image = fitted(caps)
    copies = [Silhouette(cap.mask.copy(), cap.left, cap.top) for cap in reversed(caps)]
    assert image.with_caps(copies) is image
    assert agree(image.reconstructions(copies), image.reconstructions(caps[::-1]))


def test_statistics_are_measured_on_the_caps_one_starts_with_and_hold_for_the_changed_image():
    caps = bed(6)
    image = fitted(caps)
    half = image.with_caps(caps[::2])
    assert half.statistics == image.statistics == fitted(caps[::-1]).statistics
    assert fitted(caps[::2]).statistics != image.statistics
    assert fitted([]).with_caps(caps).statistics == image.statistics


def test_an_outline_that_is_there_twice_is_one_cap():
    caps = bed(7, count=12)
    twice = [*caps, caps[3]]
    assert agree(fitted(twice).reconstructions(twice), fitted(caps).reconstructions(twice))


def test_an_image_without_caps_takes_some_and_loses_them_again():
    caps = bed(8, count=12)
    empty = fitted([])
    assert empty.reconstructions([]) == []
    filled = empty.with_caps(caps)
    assert agree(filled.reconstructions(caps), fitted(caps).reconstructions(caps))
    assert filled.with_caps([]).with_caps(caps[:1]).reconstructions(caps[:1])[0].fit.centre is not None
