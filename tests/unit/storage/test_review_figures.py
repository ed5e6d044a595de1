"""The figures of a review from the store are those of all its caps, and of the sure ones on request."""

from __future__ import annotations

import pytest
from msgspec import structs

from fairyring.storage.cap_groups import BY, By, Group
from fairyring.storage.compared_caps import KINDS, CapFigures, count_caps, list_caps
from fairyring.storage.comparisons import Comparison, list_comparisons, store_comparison
from fairyring.storage.predictions import add_predictions, add_run
from fairyring.storage.project import Project
from fairyring.storage.review_figures import shifts, totals, totals_by, untouched
from fairyring.storage.second_versions import doubts, images_compared

CAPS = (
    CapFigures(image=1, run=1, annotation="a", prediction=1, cdr=1.0, floor=0.2, dx=3.0, dy=1.0, size="m"),
    CapFigures(
        image=1,
        run=1,
        annotation="b",
        prediction=2,
        cdr=5.0,
        floor=0.4,
        dx=9.0,
        dy=1.0,
        size="m",
        unsure=True,
    ),
    CapFigures(image=1, run=1, annotation="c", prediction=None, size="s"),
    CapFigures(image=1, run=1, annotation=None, prediction=3),
    CapFigures(image=1, run=1, annotation="d", prediction=None, size="s", ignored=True),
)
FIGURES = Comparison(
    image=1, run=1, version=0, caps=3, marked=2, matched=2, missed=1, extra=1, measured=2, unsure=1,
    ignored=1, cdr_mean=3.0, cdr_worst=5.0, worst="b", floor_mean=0.3, dx=6.0, dy=1.0,
)  # fmt: skip


@pytest.fixture
def compared(beds: Project) -> Project:
    def store(connection) -> None:
        add_run(connection, name="r", kind="simulated")
        add_predictions(connection, run_id=1, image_id=1, predictions=[])
        store_comparison(connection, FIGURES, caps=CAPS)

    beds.write(store)
    return beds


def test_totals_are_means_over_caps_with_missed_and_extra_ones_apart(compared: Project) -> None:
    with compared.read() as connection:
        every, sure = totals(connection, 1), totals(connection, 1, only_sure=True)
    assert (every.cdr, every.floor, every.dx, every.dy) == pytest.approx((3.0, 0.3, 6.0, 1.0))
    assert (every.measured, every.matched, every.missed, every.extra) == (2, 2, 1, 1)
    assert (sure.cdr, sure.floor, sure.dx) == pytest.approx((1.0, 0.2, 3.0))
    assert (sure.measured, sure.missed, sure.extra) == (1, 1, 1)


def test_groups_add_up_to_the_whole_and_what_is_known_of_none_makes_no_group(compared: Project) -> None:
    with compared.read() as connection:
        by_size, by_run = totals_by(connection, 1, "size"), totals_by(connection, 1, "run")
        unknown = [by for by in BY if by not in ("size", "run", "image")]
        assert {by: totals_by(connection, 1, by) for by in unknown} == {by: {} for by in unknown}
        assert by_run == {"1": totals(connection, 1)}
        sure = totals_by(connection, 1, "run", only_sure=True)
        assert sure == {"1": totals(connection, 1, only_sure=True)}
    assert {name: (of.measured, of.missed, of.extra) for name, of in by_size.items()} == {
        "m": (2, 0, 0),
        "s": (0, 1, 0),
        None: (0, 0, 1),
    }


@pytest.mark.parametrize(
    ("by", "value", "found"),
    [
        ("size", "m", ["b", "a"]),
        ("size", "l", []),
        ("size", None, []),
        ("image", "1", ["b", "a"]),
        ("image", "2", []),
        ("image", "1; --", []),
        ("run", "1", ["b", "a"]),
        ("run", "99", []),
        ("light", None, ["b", "a"]),
    ],
)
def test_caps_of_a_group_are_listed_and_counted_alike(
    compared: Project, by: By, value: str | None, found: list[str]
) -> None:
    group = Group(by=by, value=value)
    with compared.read() as connection:
        listed = list_caps(connection, 1, "worst", group=group)
        assert [each.annotation for each in listed] == found
        for kind in KINDS:
            listed = list_caps(connection, 1, kind, group=group, limit=99)
            assert count_caps(connection, 1, group=group)[kind] == len(listed)


def test_images_can_be_listed_without_unsure_marks(compared: Project) -> None:
    with compared.read() as connection:
        (row,) = list_comparisons(connection, 1, only_sure=True).rows
    assert (row.comparison.cdr_mean, row.comparison.cdr_worst, row.comparison.worst) == (1.0, 1.0, None)
    assert row.comparison.caps == 3


def test_every_kind_of_cap_is_counted_ignored_ones_apart(compared: Project) -> None:
    with compared.read() as connection:
        assert count_caps(connection, 1) == {
            "worst": 2, "matched": 2, "missed": 1, "extra": 1, "doubtful": 0, "unsure": 1, "ignored": 1,
        }  # fmt: skip


def test_shifts_are_thinned_out_evenly_and_untouched_images_listed_apart(compared: Project) -> None:
    with compared.read() as connection:
        assert [each.dx for each in shifts(connection, 1)] == [3.0, 9.0]
        assert len(shifts(connection, 1, most=1)) <= 1
        assert untouched(connection) == (3, ["bed_1.png", "bed_2.png", "bed_10.png"])


def test_images_on_which_two_versions_differ_most_stand_first(compared: Project) -> None:
    better = structs.replace(FIGURES, image=2, missed=0, extra=1, iou_mean=0.9)
    compared.write(lambda connection: store_comparison(connection, better))
    with compared.read() as connection:
        listed = images_compared(connection, 1)
        assert doubts(connection, 1) == []  # of its predictions none is in the store
    assert [(each.image, each.missed, each.extra) for each in listed] == [(1, 1, 1), (2, 0, 1)]
