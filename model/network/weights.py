"""Weights in files: safetensors of half precision, with what must be known to build the network again.

A file is checked before it is believed: its header, the network it names, the shape of every tensor, and
the digest over all of it. Nothing in it is ever run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor

from fairyring.model.errors import FairyringError
from fairyring.model.network.config import NetworkConfig, oddity
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.whole_files import written_whole

KINDS = (torch.float16, torch.float32, torch.int64)
"""The kinds of numbers that weights are made of."""
FORMAT = "fairyring-pr-solov2-1"


class WeightsError(FairyringError):
    """Weights that cannot be used; the sentence names the file."""


@dataclass(frozen=True, kw_only=True)
class Weights:
    """A network as it was read from a file."""

    network: PRSOLOv2
    """The network, in evaluation mode, float32."""
    digest: str
    """SHA-256 over the network and all tensors: what predictions are traced to."""
    card: dict[str, Any] = field(default_factory=dict)
    """How it was trained and what it reached."""


def save_weights(
    path: Path, state: Mapping[str, Tensor], config: NetworkConfig, *, card: dict[str, Any]
) -> str:
    """Writes a network's state into the file ``path``, whole or not at all, and returns its digest.

    Floating tensors are stored in half precision; a value it cannot hold raises WeightsError.
    """
    stored = {key: _halved(key, value) for key, value in state.items()}
    described = msgspec.json.encode(config).decode()
    digest = digest_of(stored, described)
    metadata = {
        "format": FORMAT,
        "network": described,
        "digest": digest,
        "card": msgspec.json.encode(card).decode(),
    }
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with written_whole(path) as fresh:
            # save_file would let nobody but its owner read the file.
            fresh.write_bytes(save(stored, metadata=metadata))
    except (OSError, SafetensorError) as error:
        raise WeightsError(f"{path} cannot be written: {error}.") from error
    return digest


def load_weights(path: Path) -> Weights:
    """A network with the weights of a file. Raises WeightsError."""
    try:
        with safe_open(path, framework="pt") as file:
            metadata = file.metadata() or {}
            state = {key: file.get_tensor(key) for key in list(file.keys())}
    except FileNotFoundError:
        raise WeightsError(f"There are no weights at {path}; check the path.") from None
    except (OSError, SafetensorError) as error:
        raise WeightsError(
            f"{path} is not a whole safetensors file ({error}); copy it again from where it came."
        ) from error
    if metadata.get("format") != FORMAT:
        raise WeightsError(f"{path} holds no network of Fairyring's; give weights that fairyring train made.")
    _check_values(path, state)
    if metadata.get("digest") != digest_of(state, metadata.get("network", "")):
        raise WeightsError(f"{path} has been changed or damaged; copy it again from where it came.")
    # Those of older versions say nothing of it.
    state.setdefault("rim", torch.tensor(0.0))
    try:
        config = msgspec.json.decode(metadata["network"], type=NetworkConfig)
        card = msgspec.json.decode(metadata.get("card", "{}"), type=dict[str, Any])
        if odd := oddity(config):
            raise WeightsError(f"{path} describes a network that makes no sense: {odd}.")
        network = _network_of(config, state)
    except (msgspec.MsgspecError, KeyError, RuntimeError, ValueError, TypeError) as error:
        raise WeightsError(
            f"{path} holds another network than it says; it was made by another version of Fairyring."
        ) from error
    return Weights(network=network.eval(), digest=metadata["digest"], card=card)


def _check_values(path: Path, state: Mapping[str, Tensor]) -> None:
    for key, value in state.items():
        if value.dtype not in KINDS:
            raise WeightsError(f"{path} holds numbers of another kind in {key}; give weights that are whole.")
        if not torch.isfinite(value).all():
            raise WeightsError(f"{path} holds values in {key} that are not finite; train again.")


def _network_of(config: NetworkConfig, state: Mapping[str, Tensor]) -> PRSOLOv2:
    """The network that is described, with these weights.

    It is built without memory, as a description of huge layers costs nothing to write, and takes the tensors
    over once they are known to fit. Raises ValueError.
    """
    with torch.device("meta"):
        network = PRSOLOv2(config)
    wanted = network.state_dict()
    if {key: value.shape for key, value in wanted.items()} != {k: value.shape for k, value in state.items()}:
        raise ValueError("the tensors have other names or shapes")
    network.load_state_dict({key: value.to(wanted[key].dtype) for key, value in state.items()}, assign=True)
    return network


def digest_of(state: Mapping[str, Tensor], network: str) -> str:
    """SHA-256 over the network's description, and names, shapes and values of tensors in the names' order."""
    digest = hashlib.sha256(network.encode())
    for key in sorted(state):
        value = state[key].contiguous()
        digest.update(f"{key}:{value.dtype}:{tuple(value.shape)};".encode())
        digest.update(value.numpy().tobytes())
    return digest.hexdigest()


def _halved(key: str, value: Tensor) -> Tensor:
    value = value.detach().cpu()
    if not value.is_floating_point():
        return value.clone()
    if not torch.isfinite(value.half()).all():
        raise WeightsError(f"The tensor {key} holds values that are not finite; train with a lower rate.")
    # Of its own memory and order: a channels-last tensor would be stored as a view.
    return value.half().clone(memory_format=torch.contiguous_format)
