"""The devices that torch computes on."""

from __future__ import annotations

import torch

from fairyring.model.errors import FairyringError


class DeviceError(FairyringError):
    """A device that this machine does not have."""


def device_of(name: str) -> torch.device:
    """``auto`` (a GPU where there is one), ``cpu`` or ``cuda``. Raises DeviceError."""
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    if name == "cuda" and not torch.cuda.is_available():
        raise DeviceError("This machine has no GPU that PyTorch can use; take --device cpu.")
    if name not in ("cpu", "cuda"):
        raise DeviceError(f"There is no device called {name}; take auto, cpu or cuda.")
    return torch.device(name)
