"""The optimiser, its rate over time, and the average of the weights."""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn
from torch.optim.swa_utils import AveragedModel

from fairyring.model.network.lite0 import EfficientNetLite0
from fairyring.model.network.resnet import ResNet
from fairyring.model.train.recipe import Recipe

DROPS = ((0.75, 0.1), (0.92, 0.01))
"""Shares of the iterations, and the factor on the rate from there on."""
FIRST_RATE = 0.001
AVERAGED_FROM = 10
"""The average begins as if it had seen so many iterations: it follows the weights closely at first."""


def optimiser_of(network: nn.Module, recipe: Recipe) -> torch.optim.Optimizer:
    """The recipe's optimiser. Norms and biases are not decayed; the backbone has a rate of its own."""
    groups = []
    for in_backbone in (True, False):
        for decays in (True, False):
            chosen = [
                value
                for name, value in network.named_parameters()
                if name.startswith("backbone.") == in_backbone and (value.ndim > 1) == decays
                if value.requires_grad
            ]
            factor = recipe.backbone_rate if in_backbone else 1.0
            decay = recipe.weight_decay if decays else 0.0
            groups.append({"params": chosen, "factor": factor, "weight_decay": decay})
    if recipe.optimiser == "adamw":
        return torch.optim.AdamW(groups, lr=recipe.rate)
    return torch.optim.SGD(groups, lr=recipe.rate, momentum=recipe.momentum)


def rate_at(iteration: int, recipe: Recipe) -> float:
    """The rate of an iteration, counted from 0."""
    rate = recipe.rate
    share = iteration / recipe.iterations
    if recipe.schedule == "cosine":
        rate *= (1 + math.cos(math.pi * share)) / 2
    else:
        rate *= min((factor for from_here, factor in DROPS if share >= from_here), default=1.0)
    if iteration < recipe.warm_up:
        rate *= FIRST_RATE + (1 - FIRST_RATE) * iteration / recipe.warm_up
    return rate


def set_rate(optimiser: torch.optim.Optimizer, rate: float) -> None:
    """Sets the rate of every parameter group, times the group's factor."""
    for group in optimiser.param_groups:
        group["lr"] = rate * group["factor"]


def average_of(network: nn.Module, decay: float) -> AveragedModel:
    """An exponential moving average of the weights, which a short training can rely on, too."""

    def follow(average: Tensor, value: Tensor, count: Tensor | int) -> Tensor:
        return average + (value - average) * max(1 - decay, 1 / (1 + int(count) / AVERAGED_FROM))

    return AveragedModel(network, avg_fn=follow)


def freeze_stages(backbone: EfficientNetLite0 | ResNet, count: int) -> None:
    """Keeps the first stages of a backbone as they are."""
    for stage in backbone.stages()[:count]:
        for module in stage:
            module.requires_grad_(False)


def freeze_statistics(network: nn.Module) -> None:
    """Keeps the batch norms' statistics: batches of four crops are too few to measure them."""
    for module in network.modules():
        if isinstance(module, nn.BatchNorm2d):
            module.eval()
