"""Table 4, second half: other ways to run the same network, beside the predictor's own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from msgspec.structs import replace
from numpy.typing import NDArray
from torch import Tensor, nn

from fairyring.app.bench.network.cost import timed
from fairyring.model.network.pr_solov2 import Outputs, PRSOLOv2
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.predictor import Predictor


def way_rows(weights: Path, photo: NDArray[np.uint8], *, device: torch.device) -> list[dict[str, Any]]:
    """Medians of one forward pass over a photo (height, width, 3), and ratios to the predictor's own way.

    ``difference`` is the largest of any category logit from the predictor's, None where the network is
    another.
    """
    pixels = torch.from_numpy(_cut_to_multiple(photo)).to(device).permute(2, 0, 1)[None]
    ways: dict[str, Callable[[], nn.Module]] = {
        "as it predicts": lambda: _ready(weights, device),
        "batch norms not folded": lambda: load_weights(weights).network.eval().to(device),
        "channels first": lambda: _channels_first(_ready(weights, device)),
        "bfloat16": lambda: _InBf16(_ready(weights, device), device.type),
        "torch.compile": lambda: _compiled(_ready(weights, device)),
        "whole resolution, weights not made for it": lambda: _whole_resolution(weights, device),
    }
    rows: list[dict[str, Any]] = []
    first: tuple[float, Outputs] | None = None
    for name, make in ways.items():
        try:
            seconds, outputs = _measured(make(), pixels)
        except RuntimeError as error:
            reason = str(error).strip().splitlines()[0][:80]
            rows.append(_row(f"{name}: {reason}", None, None, None))
            continue
        first = first or (seconds, outputs)
        rows.append(_row(name, seconds, seconds / first[0], _difference(outputs, first[1])))
    return rows


@torch.inference_mode()
def _measured(network: nn.Module, pixels: Tensor) -> tuple[float, Outputs]:
    origins = torch.zeros(1, 2, device=pixels.device)
    return timed(lambda: network(pixels, origins), pixels.device), network(pixels, origins)


def _ready(weights: Path, device: torch.device) -> PRSOLOv2:
    return Predictor(load_weights(weights).network, device=device).network


def _channels_first(network: PRSOLOv2) -> PRSOLOv2:
    network.to(memory_format=torch.contiguous_format)  # pyright: ignore
    network.backbone.register_forward_pre_hook(lambda _, given: (given[0].contiguous(),))
    return network


def _compiled(network: PRSOLOv2) -> nn.Module:
    return torch.compile(network, dynamic=False)  # pyright: ignore


def _whole_resolution(weights: Path, device: torch.device) -> PRSOLOv2:
    """The same layers at the photo's whole resolution, over four times the pixels."""
    loaded = load_weights(weights).network
    network = PRSOLOv2(replace(loaded.config, reduction=1))
    network.load_state_dict(loaded.state_dict())
    return Predictor(network, device=device).network


class _InBf16(nn.Module):
    def __init__(self, network: PRSOLOv2, kind: str) -> None:
        super().__init__()
        self.network, self.kind = network, kind

    def forward(self, pixels: Tensor, origins: Tensor) -> Outputs:
        with torch.autocast(self.kind, torch.bfloat16):
            return self.network(pixels, origins)


def _cut_to_multiple(photo: NDArray[np.uint8]) -> NDArray[np.uint8]:
    height, width = (side // 64 * 64 for side in photo.shape[:2])
    return photo[:height, :width].copy()


def _difference(outputs: Outputs, first: Outputs) -> float | None:
    pairs = list(zip(outputs.categories, first.categories, strict=True))
    if outputs.feature.shape != first.feature.shape:
        return None
    return max(float((one - other).abs().max()) for one, other in pairs)


def _row(way: str, seconds: float | None, ratio: float | None, difference: float | None) -> dict[str, Any]:
    return {
        "forward_pass": way,
        "ms": None if seconds is None else round(1000 * seconds, 1),
        "ratio": None if ratio is None else round(ratio, 2),
        "difference": None if difference is None else float(f"{difference:.1e}"),
    }
