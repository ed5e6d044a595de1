"""Figures of groups are sums over classes of caps, and the same as those of the caps one by one."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path
from statistics import fmean
from typing import Any

import pytest
from msgspec import structs

from fairyring.storage.cap_groups import By
from fairyring.storage.compared_caps import CapFigures, scale_floors
from fairyring.storage.comparisons import Comparison, list_comparisons, store_comparison
from fairyring.storage.predictions import add_predictions, add_run
from fairyring.storage.project import Project, open_project
from fairyring.storage.review_figures import Totals, totals, totals_by
from tests.unit.storage.test_older_projects import older_project

IN_CLASSES: tuple[By, ...] = ("annotator", "size", "shape", "visibility")


def caps_of_anybody(count: int, *, image: int, seed: int) -> list[CapFigures]:
    """Caps of all kinds, some of them missed, extra, unmarked, ignored, doubtful or unsure."""
    chance = random.Random(seed)

    def cap(nth: int) -> CapFigures:
        kind = chance.choice(["measured"] * 4 + ["unmarked", "missed", "extra", "ignored"])
        is_measured = kind == "measured"
        return CapFigures(
            image=image,
            run=1,
            annotation=None if kind == "extra" else f"{image}-{nth}",
            prediction=None if kind in ("missed", "ignored") else nth,
            cdr=chance.uniform(0, 5) if is_measured else None,
            floor=chance.choice([0.2, 0.3, None]) if is_measured else None,
            own_floor=0.1 if is_measured else None,
            dx=chance.uniform(-9, 9) if is_measured else None,
            dy=chance.uniform(-9, 9) if is_measured else None,
            annotator=chance.choice(["Ada", "Ben"]),
            size=chance.choice(["s", "m", "l"]),
            shape=chance.choice(["regular", "irregular", None]),
            visibility=None if kind == "extra" else "95_percent_and_more",
            doubtful=kind != "extra" and chance.random() < 0.1,
            unsure=is_measured and chance.random() < 0.1,
            ignored=kind == "ignored",
        )

    return [cap(nth) for nth in range(count)]


CAPS = {image: caps_of_anybody(60, image=image, seed=image) for image in (1, 2)}
ALL = [cap for caps in CAPS.values() for cap in caps]


def figures_of(caps: Sequence[CapFigures], *, only_sure: bool) -> Totals:
    """One by one."""
    counted = [cap for cap in caps if not cap.ignored]
    if only_sure:
        counted = [cap for cap in counted if not cap.doubtful and not cap.unsure]
    measured = [cap for cap in counted if cap.cdr is not None]

    def mean(values: list[float | None]) -> Any:
        known = [value for value in values if value is not None]
        return pytest.approx(fmean(known)) if known else None

    return Totals(
        measured=len(measured),
        matched=sum(cap.annotation is not None and cap.prediction is not None for cap in counted),
        missed=sum(cap.prediction is None for cap in counted),
        extra=sum(cap.annotation is None for cap in counted),
        cdr=mean([cap.cdr for cap in measured]),
        floor=mean([cap.floor for cap in measured]),
        dx=mean([cap.dx for cap in measured]),
        dy=mean([cap.dy for cap in measured]),
    )


@pytest.fixture
def compared(beds: Project) -> Project:
    def store(connection) -> None:
        add_run(connection, name="r", kind="simulated")
        for image, caps in CAPS.items():
            add_predictions(connection, run_id=1, image_id=image, predictions=[])
            own = Comparison(image=image, run=1, version=0, caps=60, marked=0, matched=0, missed=0, extra=0)
            store_comparison(connection, own, caps=caps)

    beds.write(store)
    return beds


@pytest.mark.parametrize("only_sure", [False, True])
@pytest.mark.parametrize("by", IN_CLASSES)
def test_a_group_has_the_figures_of_its_caps(compared: Project, by: By, *, only_sure: bool) -> None:
    with compared.read() as connection:
        found = totals_by(connection, 1, by, only_sure=only_sure)
    values = {getattr(cap, by) for cap in ALL}
    assert found == {
        value: figures_of([cap for cap in ALL if getattr(cap, by) == value], only_sure=only_sure)
        for value in values
    }


def test_without_unsure_ones_all_and_each_image_have_the_figures_of_the_others(compared: Project) -> None:
    with compared.read() as connection:
        assert totals(connection, 1, only_sure=True) == figures_of(ALL, only_sure=True)
        rows = list_comparisons(connection, 1, sort="name", descending=False, only_sure=True).rows
    for row, caps in zip(rows, CAPS.values(), strict=True):
        alone = figures_of(caps, only_sure=True)
        assert (row.comparison.measured, row.comparison.missed) == (alone.measured, alone.missed)
        assert (row.comparison.cdr_mean, row.comparison.floor_mean) == (alone.cdr, alone.floor)


def test_floors_of_groups_follow_from_what_repeats_say_of_a_person(compared: Project) -> None:
    compared.write(lambda connection: scale_floors(connection, "Ada", overall=3.0, by_class={}))
    with compared.read() as connection:
        floors = {name: of.floor for name, of in totals_by(connection, 1, "annotator").items()}
    bens = figures_of([cap for cap in ALL if cap.annotator == "Ben"], only_sure=False)
    assert floors == {"Ada": pytest.approx(0.3), "Ben": bens.floor}


def test_an_image_compared_anew_counts_once(compared: Project) -> None:
    own = Comparison(image=1, run=1, version=0, caps=1, marked=0, matched=0, missed=1, extra=0)
    missed = CapFigures(image=1, run=1, annotation="a", prediction=None, size="s")
    compared.write(lambda connection: store_comparison(connection, own, caps=[missed]))
    with compared.read() as connection:
        found = totals_by(connection, 1, "size")
    left = [*CAPS[2], missed]
    assert found["s"] == figures_of([cap for cap in left if cap.size == "s"], only_sure=False)


def test_what_was_compared_before_the_upgrade_is_summed_up(tmp_path: Path) -> None:
    made = "INSERT INTO run (name, kind, made_at, settings) VALUES ('r', 'network', '2026-03-01', '{}')"
    columns = "image, run, annotation, prediction, cdr, floor, dx, dy, doubtful, unsure, ignored, size"
    folder = older_project(
        tmp_path / "beds",
        "0011",
        made,
        "UPDATE image SET run = 1",
        *(
            f"INSERT INTO compared_cap ({columns}) VALUES (1, 1, {figures})"
            for figures in (
                "'a', 1, 1.0, 0.25, 2.0, -1.0, 0, 0, 0, 's'",
                "'b', 2, 3.0, NULL, 4.0, -3.0, 0, 0, 0, 's'",
                "'c', NULL, NULL, NULL, NULL, NULL, 0, 0, 0, 's'",
                "NULL, 4, NULL, NULL, NULL, NULL, 0, 0, 0, 's'",
                "'d', NULL, NULL, NULL, NULL, NULL, 0, 0, 1, 's'",
            )
        ),
    )
    with open_project(folder) as project, project.read() as connection:
        found = totals_by(connection, 1, "size")
    assert structs.asdict(found["s"]) == {
        **{"measured": 2, "matched": 2, "missed": 1, "extra": 1},
        **{"cdr": 2.0, "floor": 0.25, "dx": 3.0, "dy": -2.0},
    }
