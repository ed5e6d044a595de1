"""Teaching the second look upon a network that knows its discs by heart."""

from __future__ import annotations

from dataclasses import replace as with_fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from msgspec.structs import replace

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.calibration import calibrated
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection
from fairyring.model.train.calibrating import deviation, fit_second_look
from fairyring.model.train.data import Example, read_rgb
from fairyring.model.train.loop import FINAL, train
from fairyring.model.train.second_look import with_second_look
from tests.support.discs import DISCS, RECIPE
from tests.support.small_trainings import CPU, digest_after_training, logged
from tests.unit.model.conftest import Learnt

SECOND = replace(RECIPE, learns="second look", iterations=4, warm_up=0, save_every=2)


@pytest.fixture
def base(learnt: Learnt) -> PRSOLOv2:
    return load_weights(learnt.result.weights).network


@pytest.fixture
def known(learnt: Learnt) -> list[Example]:
    """The photos with the whole outline of every disc."""
    return [
        with_fields(example, wholes=[Circle(*disc) for disc in discs])
        for example, discs in zip(learnt.examples, DISCS, strict=True)
    ]


def taught(known: list[Example], base: PRSOLOv2, out: Path, **options: Any) -> str:
    """Trains and returns the digest of the weights."""
    network = with_second_look(base, seed=0)
    recipe = replace(SECOND, network=network.config)
    return digest_after_training(known, out, recipe, base=network, **options)


def test_all_that_the_network_knew_stays_and_the_second_look_learns(
    known: list[Example], base: PRSOLOv2, tmp_path: Path
) -> None:
    taught(known, base, tmp_path / "out")
    after = load_weights(tmp_path / "out" / FINAL).network.state_dict()
    before = base.state_dict()
    for key, value in before.items():
        assert torch.equal(after[key], value), key
    added = {key for key in after if key not in before}
    assert added
    assert all(key.startswith("second_look.") for key in added)
    start = with_second_look(base, seed=0).state_dict()
    assert any(not torch.equal(after[key], start[key].half().float()) for key in added)
    (first, *_, last) = [loss for _, loss in logged(tmp_path / "out", "loss")]
    assert last < first


def test_a_training_that_was_stopped_ends_as_one_that_was_not(
    known: list[Example], base: PRSOLOv2, tmp_path: Path
) -> None:
    class StoppedError(Exception):
        pass

    def stop(progress: object) -> None:
        if getattr(progress, "iteration", 0) == 2:
            raise StoppedError

    whole = taught(known, base, tmp_path / "whole")
    with pytest.raises(StoppedError):
        taught(known, base, tmp_path / "out", report=stop)
    assert taught(known, base, tmp_path / "out", resume=True) == whole


def test_weights_without_a_second_look_say_nothing_of_quality(learnt: Learnt, base: PRSOLOv2) -> None:
    found = Predictor(base, device=CPU).detect(read_rgb(learnt.examples[0].path))
    assert found
    assert all(one.quality is None and one.whole is None for one in found)


def test_scores_are_lowered_by_the_quality(known: list[Example], base: PRSOLOv2) -> None:
    photo = read_rgb(known[0].path)
    network = with_second_look(base, seed=0)
    network.calibration.copy_(torch.tensor([1.0, 0.0]))
    assert network.second_look is not None
    raw = with_second_look(base, seed=0)
    raw.calibration.copy_(torch.tensor([1.0, 0.0]))
    raw.second_look = None
    before = Predictor(raw, device=CPU).detect(photo)
    network.second_look.quality.weight.data.zero_()
    network.second_look.quality.bias.data.fill_(float(np.log(3)))
    after = Predictor(network, device=CPU).detect(photo)
    assert [one.quality for one in after] == pytest.approx([0.75] * len(after))
    assert [one.score for one in after] == pytest.approx([0.75 * one.score for one in before], rel=1e-4)


def test_it_learns_where_whole_discs_lie_and_how_well_it_knows(
    known: list[Example], base: PRSOLOv2, tmp_path: Path
) -> None:
    recipe = replace(
        SECOND, iterations=60, save_every=100, rate=3e-3, network=with_second_look(base, seed=0).config
    )
    train(
        known,
        known,
        tmp_path / "out",
        recipe=recipe,
        device=CPU,
        base=with_second_look(base, seed=0),
        workers=0,
    )
    network = load_weights(tmp_path / "out" / FINAL).network
    found = Predictor(network, device=CPU).detect(read_rgb(known[0].path))
    sure = [one for one in found if one.score > 0.5]
    assert len(sure) == len(DISCS[0])
    for one in sure:
        assert one.whole is not None
        assert one.quality is not None
        x, y = one.whole.parameters[:2]
        cx, cy, r = min(DISCS[0], key=lambda disc: np.hypot(disc[0] - x, disc[1] - y))
        assert np.hypot(cx - x, cy - y) < 0.3 * r
        assert one.quality > 0.6


def said_to_lie(by: float) -> tuple[Example, Detection]:
    """A disc, and a perfect mask of it with a whole outline so many standard deviations too far right."""
    disc = Circle(30.0, 40.0, 20.0)
    outline = [polygon_of_shape(disc)]
    whole = LikelyEllipse(
        parameters=(30.0 + by, 40.0, float(np.log(20)), 0.0, 0.0),
        covariance=tuple(map(tuple, (np.eye(5) * 0.05**2).tolist())),
    )
    rle = rle_of_outline(outline, height=100, width=100)
    seen = Detection(score=0.9, outline=outline, rle=rle, quality=0.8, whole=whole)
    return Example(path=Path("disc.png"), width=100, height=100, caps=[outline], wholes=[disc]), seen


def test_a_deviation_is_in_standard_deviations() -> None:
    _, seen = said_to_lie(2.0)
    assert seen.whole is not None
    assert deviation(seen.whole, Circle(30.0, 40.0, 20.0)) == pytest.approx([-2, 0, 0, 0, 0], abs=1e-9)


def test_standard_deviations_are_widened_until_68_percent_lie_within_one() -> None:
    pairs = [said_to_lie(by) for by in np.linspace(0, 10, 101)]
    fitted = fit_second_look([example for example, _ in pairs], [[seen] for _, seen in pairs])
    assert fitted.spread == pytest.approx((6.827, 0, 0, 0, 0), abs=1e-6)
    # All masks are perfect: 0.8 was too low.
    assert calibrated(np.array([0.8]), fitted.quality)[0] > 0.95


def test_few_deviations_widen_nothing() -> None:
    example, seen = said_to_lie(3.0)
    assert fit_second_look([example], [[seen]]).spread == (1.0,) * 5
