"""The backbones by name, and how they start from ImageNet."""

from __future__ import annotations

from collections.abc import Mapping

from torch import Tensor, nn

from fairyring.model.errors import FairyringError
from fairyring.model.network import lite0, resnet
from fairyring.model.network.config import Backbone

Normalisation = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Mean and standard deviation of each RGB channel, of values in [0, 1]."""


def build_backbone(name: Backbone) -> lite0.EfficientNetLite0 | resnet.ResNet:
    """The backbone of this name: (B, 3, h, w) → [C2, C3, C4, C5], with ``channels`` channels each."""
    return lite0.EfficientNetLite0() if name == "lite0" else resnet.ResNet(name)


def normalisation_of(name: Backbone) -> Normalisation:
    """The normalisation of RGB values that the backbone's ImageNet weights expect."""
    return (lite0.MEAN, lite0.STD) if name == "lite0" else (resnet.MEAN, resnet.STD)


def load_backbone(backbone: nn.Module, state: Mapping[str, Tensor]) -> None:
    """Loads a classifier's weights into the backbone, its classification layers left out.

    Raises FairyringError where a tensor of the backbone is missing or of another shape.
    """
    wanted = backbone.state_dict()
    for key, value in wanted.items():
        if key not in state or state[key].shape != value.shape:
            raise FairyringError(
                f"The backbone's weights have no {key} of shape {tuple(value.shape)}; "
                "give the ImageNet weights of this very backbone."
            )
    backbone.load_state_dict({key: state[key] for key in wanted})
