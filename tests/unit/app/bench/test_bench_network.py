"""`fairyring bench network`: every table, on as few and as small beds as tell whether it works."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import torch
from typer.testing import CliRunner

from fairyring.app.bench.network import sets
from fairyring.app.bench.network.ladder import crisp, whole_resolution
from fairyring.app.bench.network.quality import rank_correlation
from fairyring.app.cli import app
from fairyring.model.network.config import NetworkConfig
from fairyring.model.scene.dataset import write_beds
from fairyring.model.scene.presets import PRESETS
from fairyring.model.scene.settings import Growth, Settings
from tests.support.sighted import write_weights

SMALL = Settings(width=320, height=192, growth=Growth(caps=(12, 14), diameters=(16, 24, 36, 48, 60)))
Table = Callable[..., list[dict[str, Any]]]


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Table:
    """Runs one of the commands on a test bed a preset, kept between calls, and returns its rows."""
    folder = tmp_path_factory.mktemp("bench")
    write_weights(folder / "small.safetensors", second_look=16)

    def rows(name: str, *options: str | Path) -> list[dict[str, Any]]:
        arguments = ["bench", "network", name, "--device", "cpu", "--json", *map(str, options)]
        if name not in ("ablation", "alike", "ladder"):
            arguments += ["--beds", str(folder / "beds"), "--weights", str(folder / "small.safetensors")]
        result = CliRunner().invoke(app, arguments, catch_exceptions=False)
        assert result.exit_code == 0, result.output
        return json.loads(result.stdout)

    return rows


@pytest.fixture(autouse=True)
def small_beds(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("paper", "farm", "default"):
        monkeypatch.setitem(PRESETS, name, SMALL)
    monkeypatch.setattr(sets, "TEST_BEDS", {"paper": (2, 3003), "farm": (1, 3001)})


def test_success_counts_every_cap_once_in_its_light_and_form(table: Table, tmp_path: Path) -> None:
    rows = table("success", "--pictures", tmp_path / "pictures")
    for name, beds in (("paper", 2), ("farm", 1)):
        mine = {row["caps_of"]: row for row in rows if row["set"] == name}
        assert 12 * beds <= mine["all"]["caps"] <= 14 * beds
        sizes = sum(row["caps"] for of, row in mine.items() if of.startswith("size"))
        assert sizes == mine["all"]["caps"]
    pictures = sorted((tmp_path / "pictures").iterdir())
    assert [path.name for path in pictures] == [
        f"{name}-{which}.jpg" for name in ("farm", "paper") for which in ("best", "typical", "worst")
    ]
    assert cv2.imread(str(pictures[0])).shape == (192, 320, 3)


def test_centres_account_for_every_cap(table: Table) -> None:
    caps = {row["set"]: row["caps"] for row in table("success") if row["caps_of"] == "all"}
    for row in table("centres"):
        assert row["matched"] + row["missed"] == caps[row["set"]]
        assert row["paper_CDR_%"] == 0.3


def test_quality_is_held_against_the_true_iou(table: Table) -> None:
    rows = {(row["set"], row["predictions"]): row for row in table("quality")}
    assert set(rows) == {(name, of) for name in ("paper", "farm") for of in ("all", "on a cap")}
    for name in ("paper", "farm"):
        everything, on_a_cap = rows[name, "all"], rows[name, "on a cap"]
        assert 0 <= on_a_cap["count"] <= everything["count"]
        assert 0 < everything["quality_mean"] < 1
        assert -1 <= everything["rank_quality"] <= 1


def test_equal_figures_share_a_rank() -> None:
    # By hand: ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4.
    ones, others = np.array([1.0, 5, 5, 9]), np.array([0.1, 0.2, 0.3, 0.4])
    assert rank_correlation(ones, others) == pytest.approx(4.5 / np.sqrt(4.5 * 5))
    assert np.isnan(rank_correlation(ones, np.array([0.1, np.nan, 0.3, 0.4])))


def test_the_stages_add_up_to_the_cost_of_a_photo(table: Table) -> None:
    rows = {row["stage"]: row for row in table("cost")}
    stages = [row["ms"] for name, row in rows.items() if row["ms"] is not None][:5]
    assert rows["decoded photo to stored centres"]["ms"] == pytest.approx(sum(stages), abs=0.5)
    reference = rows["reference: the backbone alone, full resolution"]["ms"]
    total = rows["decoded photo to stored centres"]
    assert total["ratio"] == pytest.approx(total["ms"] / reference, rel=0.05, abs=0.02)


def test_other_ways_to_run_say_the_same_where_they_should(
    table: Table, monkeypatch: pytest.MonkeyPatch
) -> None:
    def compile_nothing(*_: object, **__: object) -> None:
        raise RuntimeError("Failed to find a C++ compiler\nand more about it")

    monkeypatch.setattr(torch, "compile", compile_nothing)
    rows = {row["forward_pass"]: row for row in table("ways")}
    assert rows["as it predicts"]["ratio"] == 1
    assert rows["torch.compile: Failed to find a C++ compiler"]["ms"] is None
    for same in ("batch norms not folded", "channels first"):
        assert rows[same]["difference"] < 1e-3
    assert rows["bfloat16"]["difference"] > 0


def test_every_variant_is_trained_alike_and_once(table: Table, tmp_path: Path) -> None:
    options = ["--out", tmp_path, "--iterations", "1", "--train-beds", "1", "--crop", "64", "--count", "1"]
    rows = table("ablation", *options)
    trained = [row for row in rows if not row["network"].startswith("paper")]
    assert len({row["network"] for row in trained}) == 7
    assert [row["window"] for row in trained] == [2, 1] * 7
    recipes = [json.loads(path.read_text())["recipe"] for path in sorted(tmp_path.glob("1_*/run.json"))]
    assert len(recipes) == 7
    for setting in ("iterations", "batch", "seed", "crop", "rate"):
        assert len({json.dumps(recipe[setting]) for recipe in recipes}) == 1
    weights = {path: path.stat().st_mtime_ns for path in tmp_path.glob("1_*/weights.safetensors")}
    assert table("ablation", *options) == rows
    assert {path: path.stat().st_mtime_ns for path in tmp_path.glob("1_*/weights.safetensors")} == weights


def test_systems_trained_alike_stand_beside_the_papers_figures(table: Table, tmp_path: Path) -> None:
    options = ("--out", tmp_path, "--iterations", "1", "--crop", "64", "--train-beds", "1", "--count", "1")
    rows = table("alike", *options)
    papers = [row for row in rows if row["set"] == "the paper's"]
    assert {row["system"]: row["AP"] for row in papers} == {
        **{"Mask R-CNN": 0.8351, "YOLACT": 0.8074, "SOLOv2": 0.9028, "PR-SOLOv2": 0.9304}
    }
    ours = [(row["set"], row["system"]) for row in rows if row not in papers]
    assert sorted(ours) == sorted((name, row["system"]) for name in ("paper", "farm") for row in papers)
    for row in rows:
        if row not in papers:
            assert row["cpu_seconds"] > 0
            assert 100 < row["peak_MB"] < 4000
            assert 1 < row["parameters_M"] < 30
    assert len(list(tmp_path.glob("1_*/weights.safetensors"))) == 4


def test_the_ladder_has_a_row_for_each_step_and_set_all_trained_alike(table: Table, tmp_path: Path) -> None:
    write_beds(tmp_path / "corrected", SMALL, count=1, seed=5)
    labels = tmp_path / "corrected" / "instances.json"
    options = ("--iterations", "1", "--crop", "64", "--train-beds", "1", "--count", "1")
    rows = table("ladder", "--out", tmp_path / "runs", "--labels", labels, *options)
    steps = ["crisp rims", "soft rims", "whole resolution (aside)", "real labels", "two passes", "quality"]
    expected = [(step, name) for step in [*steps, "whole caps"] for name in ("paper", "farm")]
    assert [(row["step"], row["set"]) for row in rows] == expected
    recipes = [json.loads(path.read_text())["recipe"] for path in (tmp_path / "runs").glob("1_*/run.json")]
    assert len(recipes) == 5
    assert {(recipe["iterations"], recipe["crop"]["side"]) for recipe in recipes} == {(1, 64)}
    assert sorted(recipe["network"]["reduction"] for recipe in recipes) == [1, 2, 2, 2, 2]
    assert len({recipe["seed"] for recipe in recipes if recipe["learns"] == "network"}) == 1


def test_without_real_labels_that_step_is_left_out(table: Table, tmp_path: Path) -> None:
    options = ("--iterations", "1", "--crop", "64", "--train-beds", "1", "--count", "1")
    rows = table("ladder", "--out", tmp_path, *options)
    assert "real labels" not in {row["step"] for row in rows}
    assert len(rows) == 6 * 2


def test_crisp_beds_throw_no_light_on_each_other_and_are_all_in_focus() -> None:
    was, now = PRESETS["mixed"], crisp(PRESETS["mixed"])
    assert (now.flesh.interreflection, now.flesh.translucency) == ((0, 0), (0, 0))
    assert (now.camera.defocus, now.growth.fused) == (0, (0, 0))
    assert (now.growth.caps, now.skin, now.soil) == (was.growth.caps, was.skin, was.soil)


def test_levels_learn_caps_of_the_same_size_at_whole_resolution() -> None:
    was = NetworkConfig()
    now = whole_resolution(was)
    for before, after in zip(was.scale_ranges, now.scale_ranges, strict=True):
        assert [side * was.reduction for side in before] == [side * now.reduction for side in after]
