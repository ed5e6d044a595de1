"""Everything that must be known to build a network and to load weights into it."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

Backbone = Literal["lite0", "r18", "r34", "r50"]
PointRend = Literal["instance", "semantic", "off"]

LEVELS = 5
GROUPS = 32
"""Groups of the heads' group norms; their channels are multiples of it."""
FRAME = 1280
"""Photo pixels that the paper's images are wide: grids count cells along it, coordinates run over it."""

LIGHT_RANGES = ((1, 56), (28, 112), (56, 224), (112, 448), (224, 896))
FULL_RANGES = ((1, 96), (48, 192), (96, 384), (192, 768), (384, 2048))


class NetworkConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Architecture of a network; the default is ``lite0``, light enough for a CPU."""

    backbone: Backbone = "lite0"
    reduction: int = 2
    """Photo pixels a side of one network-input pixel; PointRend still refines edges to photo pixels."""
    fpn_channels: int = 128
    head_channels: int = 128
    head_convs: int = 2
    kernel_channels: int = 128
    """E: weights of a dynamic 1×1 convolution, channels of the mask feature."""
    grids: tuple[int, int, int, int, int] = (80, 64, 32, 16, 12)
    """S of P2…P6: cells along FRAME photo pixels. Cells are square, so a photo of another size or shape, or
    a crop, has as many as fit."""
    scale_ranges: tuple[tuple[int, int], ...] = LIGHT_RANGES
    """√(box area) of the caps each level learns, network-input pixels, inclusive."""
    point_rend: PointRend = "instance"
    """Reading A refines each instance, reading B the mask feature; ``off`` is SOLOv2."""
    point_channels: int = 128
    detail_channels: int = 16
    """Channels computed from the photo itself for PointRend's points, at stride 2; 0 as in the paper."""
    second_look: int = 0
    """Channels of the second look at found caps; 0 for none, as in the paper."""

    def cell(self, level: int) -> float:
        """Side of a cell of this level in photo pixels."""
        return FRAME / self.grids[level]

    @property
    def mask_stride(self) -> int:
        """Photo pixels a side of one cell of the mask feature."""
        return 4 * self.reduction

    @property
    def multiple(self) -> int:
        """Sides of an input are multiples of this many photo pixels."""
        return 32 * self.reduction


MOST = {
    "reduction": 8,
    "fpn_channels": 2048,
    "head_channels": 2048,
    "head_convs": 16,
    "kernel_channels": 2048,
    "point_channels": 2048,
    "detail_channels": 512,
    "second_look": 512,
}
"""Largest sensible values of a description."""
OPTIONAL = ("detail_channels", "second_look")
"""Those of which 0 means none; the others are at least 1."""
FINEST_CELL = 4
"""Least photo pixels a side of a cell of a grid."""
LARGEST_SIZE = 100_000


def oddity(config: NetworkConfig) -> str | None:
    """What of a description makes no sense, in a few words; None where all of it does."""
    for name, most in MOST.items():
        least = 0 if name in OPTIONAL else 1
        if not least <= getattr(config, name) <= most:
            return f"{name} of {getattr(config, name)}, not of {least} to {most}"
    if config.second_look and (config.point_rend != "instance" or 2 * config.second_look % GROUPS):
        return f"second_look of {config.second_look} with point_rend {config.point_rend}"
    if not all(1 <= cells <= FRAME / FINEST_CELL for cells in config.grids):
        return f"grids of {config.grids} cells"
    ranges = config.scale_ranges
    if len(ranges) != LEVELS or not all(0 <= low <= high <= LARGEST_SIZE for low, high in ranges):
        return f"scale ranges of {ranges}"
    return None


SIZES: dict[str, NetworkConfig] = {
    "lite0": NetworkConfig(),
    "r18": NetworkConfig(
        backbone="r18",
        reduction=1,
        head_channels=256,
        grids=(40, 36, 24, 16, 12),
        point_channels=256,
        detail_channels=0,
    ),
    "r50": NetworkConfig(
        backbone="r50",
        reduction=1,
        fpn_channels=256,
        head_channels=512,
        head_convs=4,
        kernel_channels=256,
        grids=(40, 36, 24, 16, 12),
        scale_ranges=FULL_RANGES,
        point_channels=256,
        detail_channels=0,
    ),
}
"""Configurations by name: the default, and the paper's network with a small and with its own backbone."""
