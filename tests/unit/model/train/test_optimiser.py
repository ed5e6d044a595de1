"""Steps: rates by hand, what decays, the average, and what stays frozen."""

from __future__ import annotations

import math

import pytest
import torch
from msgspec.structs import replace
from torch import nn

from fairyring.model.train.optimiser import (
    average_of,
    freeze_stages,
    freeze_statistics,
    optimiser_of,
    rate_at,
    set_rate,
)
from fairyring.model.train.recipe import Recipe
from tests.support.small_networks import tiny

PAPER = Recipe()


@pytest.mark.parametrize(
    ("iteration", "rate"),
    [
        (0, 0.01 * 0.001),
        (250, 0.01 * (0.001 + 0.999 / 2)),
        (500, 0.01),
        (3749, 0.01),
        (3750, 0.001),
        (4599, 0.001),
        (4600, 0.0001),
        (4999, 0.0001),
    ],
)
def test_the_papers_rates_are_those_worked_out_by_hand(iteration: int, rate: float) -> None:
    assert rate_at(iteration, PAPER) == pytest.approx(rate)


def test_rates_along_a_cosine_are_those_worked_out_by_hand() -> None:
    recipe = Recipe(schedule="cosine", iterations=300, warm_up=10, rate=2.0)
    assert rate_at(0, recipe) == pytest.approx(0.002)
    assert rate_at(100, recipe) == pytest.approx(1.5)
    assert rate_at(150, recipe) == pytest.approx(1.0)
    assert rate_at(200, recipe) == pytest.approx(0.5)
    assert rate_at(5, recipe) == pytest.approx((0.001 + 0.999 / 2) * (1 + math.cos(math.pi / 60)))


def test_without_a_warm_up_the_first_rate_is_the_rate() -> None:
    assert rate_at(0, Recipe(warm_up=0)) == 0.01


@pytest.mark.parametrize("name", ["sgd", "adamw"])
def test_norms_and_biases_do_not_decay_and_the_backbone_has_its_rate(name: str) -> None:
    network = tiny()
    recipe = Recipe(optimiser=name, weight_decay=0.02, backbone_rate=0.1)  # pyright: ignore
    optimiser = optimiser_of(network, recipe)
    set_rate(optimiser, 3.0)
    groups = {id(value): group for group in optimiser.param_groups for value in group["params"]}
    assert len(groups) == len(list(network.parameters()))
    for key, value in network.named_parameters():
        group = groups[id(value)]
        assert group["lr"] == pytest.approx(0.3 if key.startswith("backbone.") else 3.0)
        assert group["weight_decay"] == (0.02 if key.endswith("weight") and value.ndim > 1 else 0.0), key


def test_what_is_frozen_is_not_stepped() -> None:
    network = tiny()
    freeze_stages(network.backbone, 2)
    names = {key for key, value in network.named_parameters() if not value.requires_grad}
    assert {name.split(".")[1] for name in names} == {"conv_stem", "bn0", "blocks"}
    assert {int(name.split(".")[2]) for name in names if ".blocks." in name} == {0, 1, 2, 3, 4}
    optimiser = optimiser_of(network, PAPER)
    stepped = {id(value) for group in optimiser.param_groups for value in group["params"]}
    assert all((id(v) in stepped) == v.requires_grad for v in network.parameters())
    freeze_stages(network.backbone, 0)
    all_but = tiny()
    freeze_stages(all_but.backbone, 4)
    assert not any(value.requires_grad for value in all_but.backbone.parameters())
    assert all(value.requires_grad for value in all_but.kernel_head.parameters())
    assert optimiser_of(all_but, PAPER)


def test_batch_norms_keep_their_statistics() -> None:
    module = nn.Sequential(nn.Conv2d(3, 4, 1), nn.BatchNorm2d(4), nn.Dropout())
    module.train()
    freeze_statistics(module)
    assert not module[1].training
    assert module[2].training
    module(torch.randn(2, 3, 4, 4) + 5)
    assert isinstance(module[1], nn.BatchNorm2d)
    assert module[1].running_mean is not None
    assert module[1].running_mean.eq(0).all()


def test_the_average_follows_closely_at_first_and_slowly_later() -> None:
    network = nn.Linear(1, 1)
    weight = network.bias
    average = average_of(network, 0.99)  # pyright: ignore
    kept = average.module.get_parameter("bias")
    expected = 0.0
    for count in range(1200):
        with torch.no_grad():
            weight.fill_(float(count % 7))
        average.update_parameters(network)
        # The first update copies; the nth moves by 1 / (1 + n / 10), and by no less than 1 - 0.99.
        share = 1.0 if count == 0 else max(1 - 0.99, 1 / (1 + count / 10))
        expected += (count % 7 - expected) * share
        assert kept[0].item() == pytest.approx(expected, rel=1e-4)
    assert share == pytest.approx(0.01)


def test_rates_stay_finite_for_a_run_of_one_iteration() -> None:
    for schedule in ("steps", "cosine"):
        assert rate_at(0, replace(PAPER, iterations=1, schedule=schedule)) > 0
