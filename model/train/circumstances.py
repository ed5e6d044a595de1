"""With what a training ran, and for how long.

Kept in ``run.json`` and not in the weights, which are the same whenever they were made.
"""

from __future__ import annotations

import platform
import time
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import msgspec
import torch

KEY = "circumstances"
PACKAGES = ("fairyring", "torch", "numpy", "opencv-python-headless", "pycocotools")


class Circumstances:
    """Versions, device and duration of one training, also over several attempts."""

    def __init__(self, file: Path, card: dict[str, Any], device: torch.device, *, processes: int) -> None:
        self._file, self._card = file, card
        earlier = _earlier(file)
        self._began, self._before = time.monotonic(), float(earlier.get("seconds", 0.0))
        self._kept = {
            "versions": {"python": platform.python_version()} | _versions(),
            "device": _name_of(device),
            "processes": processes,
            "started_at": earlier.get("started_at") or datetime.now(UTC).isoformat(timespec="seconds"),
        }

    def write(self) -> None:
        """Writes ``run.json`` with what is known by now."""
        seconds = round(self._before + time.monotonic() - self._began, 1)
        content = self._card | {KEY: self._kept | {"seconds": seconds}}
        self._file.write_bytes(msgspec.json.format(msgspec.json.encode(content), indent=2))


def _earlier(file: Path) -> dict[str, Any]:
    """What an earlier attempt of the same training noted; nothing where there was none."""
    try:
        noted = msgspec.json.decode(file.read_bytes(), type=dict[str, Any]).get(KEY)
    except (OSError, msgspec.MsgspecError):
        return {}
    return noted if isinstance(noted, dict) else {}


def _versions() -> dict[str, str]:
    versions = {}
    for package in PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return versions


def _name_of(device: torch.device) -> str:
    if device.type == "cuda":
        return torch.cuda.get_device_name(device)
    return f"{device.type}, {platform.processor() or platform.machine()}, {torch.get_num_threads()} threads"
