"""The log of a training and its curves."""

from __future__ import annotations

from pathlib import Path

import cv2
import pytest

from fairyring.model.train import log as train_log


def step(iteration: int) -> dict[str, float]:
    return {"iteration": iteration, "category": 1.0, "mask": 0.5, "points": 0.2, "rate": 0.01}


def check(iteration: int, **figures: float) -> dict[str, float]:
    return {"iteration": iteration, "AP": 0.5, "AP50": 0.9, "AP75": 0.6, **figures}


def test_what_is_logged_is_read_again(tmp_path: Path) -> None:
    assert train_log.read(tmp_path) == []
    train_log.append(tmp_path, [step(1)])
    train_log.append(tmp_path, [step(2), check(2)])
    assert train_log.read(tmp_path) == [step(1), step(2), check(2)]


def test_a_half_written_line_is_left_out(tmp_path: Path) -> None:
    train_log.append(tmp_path, [step(1), step(2)])
    path = tmp_path / train_log.LOG
    path.write_text(path.read_text()[:-9])
    assert train_log.read(tmp_path) == [step(1)]


def test_what_came_after_is_forgotten(tmp_path: Path) -> None:
    train_log.append(tmp_path, [step(1), step(2), check(2), step(3), check(3)])
    train_log.cut_after(tmp_path, 2)
    assert train_log.read(tmp_path) == [step(1), step(2), check(2)]
    train_log.append(tmp_path, [step(3)])
    assert train_log.read(tmp_path)[-1] == step(3)
    train_log.cut_after(tmp_path, 0)
    assert train_log.read(tmp_path) == []


@pytest.mark.parametrize(
    "entries",
    [
        [],
        [step(1)],
        [step(1), check(1, S50=0.9), step(2), check(2)],
        [check(5)],
    ],
)
def test_curves_are_drawn_of_whatever_is_there(tmp_path: Path, entries: list[dict[str, float]]) -> None:
    train_log.append(tmp_path, entries)
    train_log.draw_curves(tmp_path)
    picture = cv2.imread(str(tmp_path / train_log.CURVES))
    assert picture is not None
    assert picture.shape == (440, 1100, 3)


def test_curves_are_means_with_those_before() -> None:
    smoothed = train_log._smoothed([2.0, 4.0, 9.0])  # pyright: ignore
    assert smoothed == pytest.approx([2, 3, 5])
    long = train_log._smoothed([0.0] * 30 + [25.0])  # pyright: ignore
    assert long[-1] == pytest.approx(1)
