"""The state of a training, which changes from iteration to iteration."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import msgspec
import torch
from torch.optim.swa_utils import AveragedModel

from fairyring.model.network.backbone import load_backbone
from fairyring.model.network.lite0 import imagenet_weights
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.train.divergence import Losses
from fairyring.model.train.optimiser import average_of, freeze_stages, optimiser_of
from fairyring.model.train.recipe import Recipe
from fairyring.model.train.second_look import learn_only_the_second_look


@dataclass(kw_only=True)
class TrainingState:
    """What changes from iteration to iteration."""

    network: PRSOLOv2
    optimiser: torch.optim.Optimizer
    average: AveragedModel | None
    iteration: int = 0
    best: dict[str, Any] = field(default_factory=dict)
    checked: int = 0
    """The iteration that was validated last."""
    losses: Losses = field(default_factory=Losses)
    stepping: bool = False
    """Whether the weights are half way between two iterations."""

    @property
    def kept(self) -> PRSOLOv2:
        """The network whose weights count: the average where there is one."""
        return self.network if self.average is None else self.average.module  # pyright: ignore

    def as_checkpoint(self) -> dict[str, Any]:
        """All of it, as a checkpoint keeps it."""
        return {
            "network": self.network.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "average": self.average.state_dict() if self.average else None,
            "iteration": self.iteration,
            "best": msgspec.json.encode(self.best).decode(),
            "checked": self.checked,
            "losses": {"first": self.losses.first, "last": self.losses.last},
        }

    def restore(self, saved: dict[str, Any]) -> None:
        """Goes back to where ``as_checkpoint`` was called."""
        self.network.load_state_dict(saved["network"])
        self.optimiser.load_state_dict(saved["optimiser"])
        if self.average is not None:
            self.average.load_state_dict(saved["average"])
        self.iteration = saved["iteration"]
        self.best = msgspec.json.decode(saved["best"])
        self.checked = saved.get("checked", self.iteration)
        self.losses = Losses(**saved.get("losses", {}))


def new_network(recipe: Recipe) -> PRSOLOv2:
    """A new network, its backbone with ImageNet weights where those are installed."""
    network = PRSOLOv2(recipe.network)
    state = imagenet_weights() if recipe.network.backbone == "lite0" else None
    if state is not None:
        load_backbone(network.backbone, state)
    return network


def first_state(network: PRSOLOv2, recipe: Recipe, *, device: torch.device) -> TrainingState:
    """The state before the first iteration; this very network is trained."""
    if recipe.learns == "second look":
        learn_only_the_second_look(network)
    else:
        freeze_stages(network.backbone, recipe.frozen)
    network = network.to(device=device, memory_format=torch.channels_last)  # pyright: ignore
    return TrainingState(
        network=network,
        optimiser=optimiser_of(network, recipe),
        average=average_of(network, recipe.average) if recipe.average else None,
    )
