"""From a photo to the caps that a peer sees in it."""

from __future__ import annotations

import numpy as np
import torch

from fairyring.model.network.config import NetworkConfig
from fairyring.model.peers.mask_rcnn import MaskRCNN
from fairyring.model.peers.seen import detections_of
from fairyring.model.peers.yolact import YOLACT
from fairyring.model.photo import Pixels
from fairyring.model.predict.seen import Detection


def detect(photo: Pixels, *, network: MaskRCNN | YOLACT) -> list[Detection]:
    """The caps of a photo (height, width, 3) uint8 RGB, best first."""
    height, width = photo.shape[:2]
    padded = np.zeros((*(_up_to_multiple(side, network.config) for side in (height, width)), 3), np.uint8)
    padded[:height, :width] = photo
    device = next(network.parameters()).device
    pixels = torch.from_numpy(padded).permute(2, 0, 1)[None].to(device)
    return detections_of(network.see(pixels), width=width, height=height)


def _up_to_multiple(side: int, config: NetworkConfig) -> int:
    return -(-side // config.multiple) * config.multiple
