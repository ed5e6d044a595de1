"""Feature pyramid (Lin et al., CVPR 2017) as SOLOv2 uses it: P2…P5 by top-down sums, P6 by subsampling."""

from __future__ import annotations

from collections.abc import Sequence

from torch import Tensor, nn
from torch.nn import functional as F


class FeaturePyramid(nn.Module):
    """[C2, C3, C4, C5] → [P2, P3, P4, P5, P6], all of ``outputs`` channels, strides 4, 8, 16, 32, 64."""

    def __init__(self, inputs: Sequence[int], outputs: int) -> None:
        super().__init__()
        self.lateral = nn.ModuleList(_started(nn.Conv2d(channels, outputs, 1)) for channels in inputs)
        self.smooth = nn.ModuleList(_started(nn.Conv2d(outputs, outputs, 3, padding=1)) for _ in inputs)

    def forward(self, levels: Sequence[Tensor]) -> list[Tensor]:
        """Each (B, outputs, h / stride, w / stride)."""
        sums = [lateral(level) for lateral, level in zip(self.lateral, levels, strict=True)]
        for finer in range(len(sums) - 2, -1, -1):
            sums[finer] = sums[finer] + F.interpolate(sums[finer + 1], size=sums[finer].shape[-2:])
        pyramid = [smooth(level) for smooth, level in zip(self.smooth, sums, strict=True)]
        return [*pyramid, F.max_pool2d(pyramid[-1], 1, stride=2)]


def _started(conv: nn.Conv2d) -> nn.Conv2d:
    nn.init.xavier_uniform_(conv.weight)
    assert conv.bias is not None
    nn.init.zeros_(conv.bias)
    return conv
