"""A photo that went through the network, and a cap as it is read from that."""

from __future__ import annotations

from dataclasses import dataclass

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.raster import Rle
from fairyring.model.geometry.shapes import Outline
from fairyring.model.network.pr_solov2 import Outputs
from fairyring.model.photo import Pixels
from fairyring.model.predict.passes import Pass
from fairyring.model.predict.tiles import Tile


@dataclass(frozen=True, kw_only=True)
class Detection:
    """One cap as the network sees it."""

    score: float
    """Probability that this is a cap and the outline its own, 0 to 1."""
    outline: Outline
    """Outline of what is visible, with sub-pixel edges."""
    rle: Rle
    """The pixels of the outline."""
    quality: float | None = None
    """Expected IoU of the outline with the visible cap; None where the network takes no second look."""
    whole: LikelyEllipse | None = None
    """The whole outline as the second look sees it."""


@dataclass(frozen=True, kw_only=True)
class SeenPiece:
    """A piece of a photo in one pass, and the network's outputs for it."""

    seen_in: Pass
    tile: Tile
    outputs: Outputs
    """For the batch that the piece was in."""
    index: int
    """Of the piece in that batch."""


@dataclass(frozen=True, kw_only=True)
class Seen:
    """A photo that went through the network."""

    width: int
    height: int
    photo: Pixels
    """The scaled photo."""
    pieces: list[SeenPiece]

    @property
    def scaled(self) -> tuple[int, int]:
        """Width and height of the scaled photo."""
        return self.photo.shape[1], self.photo.shape[0]
