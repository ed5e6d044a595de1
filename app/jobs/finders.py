"""What finds caps in photos: a network, or a method that goes by colour."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

import msgspec

from fairyring.model.colour.methods import Method, find_caps
from fairyring.model.device import device_of
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Outline
from fairyring.model.network.config import SIZES, NetworkConfig
from fairyring.model.network.weights import load_weights
from fairyring.model.photo import Pixels
from fairyring.model.predict.passes import TWO_PASSES, Pass
from fairyring.model.predict.predictor import PredictConfig, Predictor
from fairyring.model.predict.scale import detect_at_its_scale

LEAST_SCORE = 0.3
"""Predictions with a lower score are not stored: people would have to delete most of them one by one."""


class Finder(Protocol):
    """What finds caps in photos, with the name and settings of its runs."""

    @property
    def name(self) -> str:
        """As people read it."""
        ...

    @property
    def digest(self) -> str | None:
        """SHA-256 of its weights; None where it has none."""
        ...

    @property
    def settings(self) -> dict[str, Any]:
        """All other settings that decide what it finds."""
        ...

    def find(self, photo: Pixels) -> list[SeenCap]:
        """Every cap in a photo (height, width, 3) uint8 RGB."""
        ...


@dataclass(frozen=True, kw_only=True)
class SeenCap:
    """A cap that was found in a photo."""

    score: float
    outline: Outline
    """Visible outline."""
    quality: float | None = None
    """Expected IoU of the outline with the visible cap; None where it is not known."""
    whole: LikelyEllipse | None = None
    """The whole outline as the network sees it; None where it does not say."""


@dataclass(frozen=True, kw_only=True)
class ByColour:
    """A method that needs no weights."""

    method: Method
    diameter: float | None
    """How wide the photos' middling caps are, pixels; None: measured in each photo."""

    digest = None

    @property
    def name(self) -> str:
        """The method's."""
        return self.method

    @property
    def settings(self) -> dict[str, Any]:
        """The method, and the diameter where it was said."""
        said = {} if self.diameter is None else {"diameter": self.diameter}
        return {"method": self.method} | said

    def find(self, photo: Pixels) -> list[SeenCap]:
        """Every cap; the score is no probability."""
        found = find_caps(photo, self.method, diameter=self.diameter)
        return [SeenCap(score=each.score, outline=each.outline) for each in found]


@dataclass(frozen=True, kw_only=True)
class Network:
    """A network that is ready to predict, with the name and settings of its runs."""

    predictor: Predictor
    name: str
    digest: str
    """SHA-256 of the weights."""
    settings: dict[str, Any]
    """All other settings that decide its predictions."""
    diameter: float | None
    """How wide the photos' middling caps are, pixels; None: looked for in each photo."""

    def find(self, photo: Pixels) -> list[SeenCap]:
        """Every cap."""
        found = detect_at_its_scale(self.predictor, photo, diameter=self.diameter)
        return [
            SeenCap(score=each.score, outline=each.outline, quality=each.quality, whole=each.whole)
            for each in found
        ]


def network_of(
    weights: Path,
    *,
    device: str = "auto",
    least_score: float = LEAST_SCORE,
    passes: tuple[Pass, ...] = TWO_PASSES,
    diameter: float | None = None,
) -> Network:
    """Reads weights; those read last are kept ready. Raises WeightsError, DeviceError."""
    changed = weights.stat().st_mtime_ns if weights.exists() else 0
    network = _network_of(weights, changed, device, least_score, passes)
    if diameter is None:
        return network
    return replace(network, diameter=diameter, settings=network.settings | {"diameter": diameter})


@lru_cache(maxsize=1)
def _network_of(
    weights: Path, _changed: int, device: str, least_score: float, passes: tuple[Pass, ...]
) -> Network:
    on = device_of(device)
    loaded = load_weights(weights)
    config, settings = loaded.network.config, PredictConfig(least_score=least_score, passes=passes)
    predictor = Predictor(loaded.network, device=on, settings=settings)
    return Network(
        predictor=predictor,
        name=f"{weights.stem} {loaded.digest[:8]}",
        digest=loaded.digest,
        settings={
            "network": _size_of(config),
            "decode": msgspec.to_builtins(settings.decode),
            "finest": settings.finest,
            "least_score": least_score,
            "passes": [msgspec.to_builtins(each) for each in passes],
        },
        diameter=None,
    )


def _size_of(config: NetworkConfig) -> str:
    plain = msgspec.structs.replace(config, second_look=0)
    return next((name for name, size in SIZES.items() if size == plain), f"{config.backbone}, own settings")
