"""What is known of caps before one is looked at, and where that is known from."""

from __future__ import annotations

from math import isfinite
from pathlib import Path

import msgspec
from msgspec import Struct

from fairyring.model.errors import FairyringError


class Priors(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Widths are standard deviations; shapes are relative to the radius."""

    source: str
    """Where the figures come from."""
    stretch: float
    """Width of each of the two components (u, v) of the ellipse r·expm([[u, v], [v, −u]])."""
    stretch_hidden: float = 1.7
    """How much wider that is taken to be until it is measured on an image's caps: some are tilted."""
    wobble: tuple[float, ...]
    """Width of each component of the third harmonic of the outline, the fourth, …"""
    size: float
    """Width of log(longest radius / radius of the circle around what is visible)."""
    size_shift: float = 0.0
    """How much larger the mean of that is than `expected_reach` says."""
    noise: float = 0.3
    """Standard deviation of a rim point, pixels; leant on where an image shows too little rim."""
    noise_floor: float = 0.2
    """Power of a perfect mask's outline noise, px³: variance × length of outline per independent sample."""
    noise_length: float = 36.0
    """Length of outline per independent sample of what noise there is beyond a perfect mask's, pixels."""


DEFAULT = Priors(
    source="clusters of model.scene.clusters, widened to cover photographed beds",
    stretch=0.05,
    wobble=(0.015, 0.010, 0.007),
    size=0.12,
)


class PriorsError(FairyringError):
    """A file of priors that cannot be used."""


def read_priors(path: Path) -> Priors:
    """What ``write_priors`` wrote; PriorsError with the file's name if it is anything else."""
    try:
        priors = msgspec.json.decode(path.read_bytes(), type=Priors)
    except OSError as error:
        raise PriorsError(f"{path} cannot be read: {error.strerror}.") from error
    except msgspec.MsgspecError as error:
        raise PriorsError(f"{path} holds no priors ({error}). Make some with fairyring priors.") from error
    widths = (priors.stretch, priors.stretch_hidden, priors.size, *priors.wobble)
    widths += (priors.noise, priors.noise_floor)
    if not all(isfinite(width) and width > 0 for width in widths) or priors.noise_length < 0:
        raise PriorsError(f"{path} has a width that is not above zero. Make it again with fairyring priors.")
    return priors


def write_priors(priors: Priors, path: Path) -> None:
    """Writes priors as JSON, one figure a line."""
    path.write_bytes(msgspec.json.format(msgspec.json.encode(priors), indent=2) + b"\n")
