"""Training of the peers as PR-SOLOv2 is trained: the same crops, optimiser, rates, seed and average."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from safetensors.torch import load_file, save_file
from torch import Tensor, nn
from torch.optim.swa_utils import AveragedModel

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.objective import Batch
from fairyring.model.peers import mask_rcnn_loss, yolact_loss
from fairyring.model.peers.mask_rcnn import MaskRCNN
from fairyring.model.peers.yolact import YOLACT
from fairyring.model.progress import Progress, silent
from fairyring.model.train.checkpoint import CHECKPOINT, load_checkpoint, save_checkpoint
from fairyring.model.train.data import Example
from fairyring.model.train.distributed import Process
from fairyring.model.train.loading import batches_of
from fairyring.model.train.loop import SEEDS
from fairyring.model.train.optimiser import (
    average_of,
    freeze_stages,
    freeze_statistics,
    optimiser_of,
    rate_at,
    set_rate,
)
from fairyring.model.train.recipe import Recipe

WEIGHTS = "weights.safetensors"


@dataclass(frozen=True, kw_only=True)
class Peer:
    """A system beside PR-SOLOv2."""

    build: Callable[[NetworkConfig], MaskRCNN | YOLACT]
    losses: Callable[..., dict[str, Tensor]]
    """Of the network and a `Batch`: the terms of the loss by name."""


PEERS = {
    "Mask R-CNN": Peer(build=MaskRCNN, losses=mask_rcnn_loss.losses_of),
    "YOLACT": Peer(build=YOLACT, losses=yolact_loss.losses_of),
}


@dataclass(frozen=True, kw_only=True)
class _Training:
    """What changes from iteration to iteration."""

    network: MaskRCNN | YOLACT
    optimiser: torch.optim.Optimizer
    average: AveragedModel

    def saved(self, folder: Path, *, iteration: int) -> None:
        """Writes a checkpoint after so many iterations."""
        parts = {name: part.state_dict() for name, part in self._parts().items()}
        save_checkpoint(folder, parts | {"iteration": iteration})

    def restored(self, folder: Path, *, device: torch.device) -> int:
        """Goes back to the checkpoint in a folder, and says after how many iterations that was."""
        if not (folder / CHECKPOINT).exists():
            return 0
        state = load_checkpoint(folder, device=device)
        for name, part in self._parts().items():
            part.load_state_dict(state[name])
        return state["iteration"]

    def _parts(self) -> dict[str, Any]:
        return {"network": self.network, "optimiser": self.optimiser, "average": self.average}


def trained_peer(
    name: str,
    examples: Sequence[Example],
    out: Path,
    *,
    recipe: Recipe,
    device: torch.device,
    progress: Progress = silent,
) -> MaskRCNN | YOLACT:
    """One of PEERS, trained by the recipe in ``out``, going on with what is there; ready to see.

    Raises CheckpointError, DataError.
    """
    torch.manual_seed(recipe.seed)
    peer = PEERS[name]
    network = peer.build(recipe.network).to(device)
    out.mkdir(parents=True, exist_ok=True)
    if not (out / WEIGHTS).exists():
        freeze_stages(network.backbone, recipe.frozen)
        training = _Training(
            network=network,
            optimiser=optimiser_of(network, recipe),
            average=average_of(network, recipe.average),
        )
        first = training.restored(out, device=device)
        batches = batches_of(examples, recipe, first=first, workers=1, process=Process(device=device))
        for done, gathered in enumerate(batches, start=first + 1):
            _iterate(training, peer, gathered, recipe, nth=done - 1)
            progress(done, recipe.iterations, f"training {name}")
            if done % recipe.save_every == 0:
                training.saved(out, iteration=done)
        save_file(training.average.module.state_dict(), out / WEIGHTS)
    network.load_state_dict(load_file(out / WEIGHTS))
    return network.eval()


def _iterate(training: _Training, peer: Peer, gathered: Sequence[Batch], recipe: Recipe, *, nth: int) -> None:
    """One step of the optimiser; ``nth`` counts from 0."""
    # All randomness of an iteration depends on its number alone, so that a resumed training repeats it.
    torch.manual_seed(recipe.seed * SEEDS + nth)
    network, optimiser = training.network.train(), training.optimiser
    freeze_statistics(network)
    set_rate(optimiser, rate_at(nth, recipe))
    optimiser.zero_grad(set_to_none=True)
    device = next(network.parameters()).device
    for batch in gathered:
        terms = peer.losses(network, batch.to(device))
        (torch.stack(list(terms.values())).sum() / len(gathered)).backward()
    nn.utils.clip_grad_norm_(network.parameters(), recipe.clip)
    optimiser.step()
    training.average.update_parameters(network)
