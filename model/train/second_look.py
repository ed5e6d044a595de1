"""Teaches the second look on what a finished network finds in crops, as prediction would find it."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from msgspec.structs import replace
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.decode import DecodeConfig
from fairyring.model.network.objective import Batch, Caps
from fairyring.model.network.pr_solov2 import Outputs, PRSOLOv2
from fairyring.model.network.second_look import PARAMETERS, Said, Windows, gaussian_loss
from fairyring.model.predict.looking_again import cut_out, windows_in
from fairyring.model.predict.overlaps import Window
from fairyring.model.predict.passes import Pass
from fairyring.model.predict.pooling import Found
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Seen, SeenPiece
from fairyring.model.predict.tiles import tiles_of

CHANNELS = 32
"""Width of a second look that is added to a network."""
LEAST_SCORE = 0.1
"""Raw score of the caps that are looked at again: those of lower ones are hardly ever kept."""
SAME_CAP = 0.5
"""IoU from which a mask is of a cap, and tells of its whole ellipse."""


class SecondLosses(NamedTuple):
    """The terms of the loss, scalars; each is 0 where nothing of its kind is in the batch."""

    quality: Tensor
    whole: Tensor

    @property
    def total(self) -> Tensor:
        """Their sum."""
        return self.quality + self.whole


class SecondStep(nn.Module):
    """What is found in a batch, and the losses of the network's second look at it.

    Finding is done by a copy of the network as it is now; only the second look may learn.
    """

    def __init__(self, network: PRSOLOv2) -> None:
        super().__init__()
        assert network.second_look is not None
        self.look = network.second_look
        # In a list, for its parameters are not this step's.
        self._finder = [Predictor(copy.deepcopy(network), device=_device_of(network))]

    def forward(self, batch: Batch) -> SecondLosses:
        """Losses over all caps found in the batch."""
        found = examples_in(self._finder[0], batch)
        if found is None:
            nothing = sum(value.sum() for value in self.look.parameters()) * torch.zeros(())
            return SecondLosses(nothing, nothing)
        said = self.look(found.outputs.point_maps, found.windows)
        return losses_of(said, found.qualities, found.wholes)


def losses_of(said: Said, qualities: Tensor, wholes: Tensor) -> SecondLosses:
    """``qualities`` (n,) true IoUs; ``wholes`` (n, PARAMETERS), NaN where the whole ellipse is not known."""
    quality = F.binary_cross_entropy_with_logits(said.quality.float(), qualities)
    known = wholes.isfinite().all(1)
    chosen = Said(*(part[known] for part in said))
    whole = gaussian_loss(chosen, wholes[known]).sum() / known.sum().clamp(min=1) / PARAMETERS
    return SecondLosses(quality, whole)


class Examples(NamedTuple):
    """n ≥ 1 caps found in a batch, and what is true of each."""

    outputs: Outputs
    windows: Windows
    qualities: Tensor
    """(n,)."""
    wholes: Tensor
    """(n, PARAMETERS), relative to the windows."""


@torch.no_grad()
def examples_in(finder: Predictor, batch: Batch) -> Examples | None:
    """What the network finds in the crops of a batch, as in photos; None where it finds nothing."""
    outputs = finder.network(batch.photos, batch.origins)
    height, width = batch.photos.shape[-2:]
    settings = replace(DecodeConfig(), least_score=LEAST_SCORE)
    parts = []
    for nth, caps in enumerate(batch.caps):
        photo = batch.photos[nth].permute(1, 2, 0).cpu().numpy()
        (tile,) = tiles_of(width, height)
        piece = SeenPiece(seen_in=Pass(), tile=tile, outputs=outputs, index=nth)
        seen = Seen(width=width, height=height, photo=photo, pieces=[piece])
        found = finder.pool(seen, finder.refine(seen, settings))
        found, qualities, owners = _judged(found, caps)
        if found:
            cut = cut_out(photo, [one.window for one in found])
            windows = windows_in(piece, cut, found, range(len(found)))
            parts.append((windows, torch.from_numpy(qualities), _wholes_of(caps, owners, cut.places)))
    if not parts:
        return None
    windows = Windows(*(torch.cat(layer) for layer in zip(*(part[0] for part in parts), strict=True)))
    device = windows.scores.device
    qualities, wholes = (torch.cat([part[place] for part in parts]).to(device) for place in (1, 2))
    return Examples(outputs, windows, qualities, wholes)


def _judged(found: Sequence[Found], caps: Caps) -> tuple[list[Found], NDArray[np.float32], NDArray[np.int64]]:
    """What was found where the caps are known, its IoU with the cap most like it, and which; -1 for none."""
    masks, ignored = caps.masks.cpu().numpy(), caps.ignored.cpu().numpy()
    areas = masks.sum((1, 2))
    kept, qualities, owners = [], [], []
    for one in found:
        held, here = _held(one.window)
        common = (masks[:, *here] & held).sum((1, 2)) if len(masks) else np.zeros(0)
        ious = common / (areas + held.sum() - common)
        best = int(ious.argmax()) if len(ious) else -1
        iou = float(ious[best]) if best >= 0 else 0.0
        if iou < SAME_CAP and ignored[here][held].mean() > SAME_CAP:
            continue
        kept.append(one)
        qualities.append(iou)
        owners.append(best if iou >= SAME_CAP else -1)
    return kept, np.array(qualities, np.float32), np.array(owners, np.int64)


def _held(window: Window) -> tuple[NDArray[np.bool_], tuple[slice, slice]]:
    rows, columns = window.logits.shape
    return window.logits > 0, (
        slice(window.y, window.y + rows),
        slice(window.x, window.x + columns),
    )


def _wholes_of(caps: Caps, owners: NDArray[np.int64], places: NDArray[np.float32]) -> Tensor:
    """(n, PARAMETERS) of the caps found, relative to their windows; NaN where not known."""
    wholes = np.full((len(owners), PARAMETERS), np.nan)
    of_a_cap = owners >= 0
    wholes[of_a_cap] = caps.wholes.cpu().numpy()[owners[of_a_cap]]
    wholes[:, :2] = (wholes[:, :2] - places[:, :2]) / places[:, 2:]
    wholes[:, 2] -= np.log(places[:, 2] / 2)
    return torch.from_numpy(wholes.astype(np.float32))


def with_second_look(network: PRSOLOv2, *, seed: int) -> PRSOLOv2:
    """The network, with a new second look where it has none; it shares nothing with the one given."""
    torch.manual_seed(seed)
    if network.second_look is not None:
        return copy.deepcopy(network)
    wider = PRSOLOv2(replace(network.config, second_look=CHANNELS))
    wider.load_state_dict(network.state_dict(), strict=False)
    return wider


def learn_only_the_second_look(network: PRSOLOv2) -> None:
    """Keeps all else as it is."""
    network.requires_grad_(False)
    if network.second_look is not None:
        network.second_look.requires_grad_(True)


def _device_of(network: PRSOLOv2) -> torch.device:
    return next(network.parameters()).device
