"""Where in the photo a pixel of a feature map lies: the two channels that tell alike caps apart.

SOLOv2 runs them from -1 to 1 over its input. Here they run so over the FRAME of a whole photo, and a crop
says which piece of it it stands for: what is learnt on crops then holds on photos.
"""

from __future__ import annotations

import torch
from torch import Tensor

from fairyring.model.network.config import FRAME


def with_coordinates(features: Tensor, origins: Tensor, *, extent: tuple[int, int]) -> Tensor:
    """(B, C, h, w) → (B, C + 2, h, w), x and y last.

    ``origins`` (B, 2): x, y of the input's first corner, photo pixels from the photo's middle; ``extent``:
    height and width of the input, photo pixels. The value at a feature pixel is its middle's, over FRAME /
    2.
    """
    height, width = features.shape[-2:]
    options = {"device": features.device, "dtype": torch.float32}
    x = (torch.arange(width, **options) + 0.5) * (extent[1] / width)
    y = (torch.arange(height, **options) + 0.5) * (extent[0] / height)
    xs = (origins[:, 0, None] + x)[:, None, None, :].expand(-1, 1, height, -1)
    ys = (origins[:, 1, None] + y)[:, None, :, None].expand(-1, 1, -1, width)
    return torch.cat([features, (torch.cat([xs, ys], 1) / (FRAME / 2)).to(features.dtype)], dim=1)
