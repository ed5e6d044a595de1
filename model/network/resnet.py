"""ResNet-18, -34 and -50 as backbones, named as in torchvision, so that its state dicts load.

He et al., Deep Residual Learning (CVPR 2016); stride 2 on the 3×3 convolution, as torchvision has it.
"""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn import functional as F

MEAN, STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)
DEPTHS = {"r18": (2, 2, 2, 2), "r34": (3, 4, 6, 3), "r50": (3, 4, 6, 3)}


def _shortcut(inputs: int, outputs: int, stride: int) -> nn.Sequential | None:
    if stride == 1 and inputs == outputs:
        return None
    return nn.Sequential(nn.Conv2d(inputs, outputs, 1, stride, bias=False), nn.BatchNorm2d(outputs))


class Basic(nn.Module):
    """Two 3×3 convolutions: (B, inputs, h, w) → (B, width, h / stride, w / stride)."""

    expansion = 1

    def __init__(self, inputs: int, width: int, stride: int) -> None:
        super().__init__()
        self.conv1 = nn.Conv2d(inputs, width, 3, stride, 1, bias=False)
        self.bn1 = nn.BatchNorm2d(width)
        self.conv2 = nn.Conv2d(width, width, 3, 1, 1, bias=False)
        self.bn2 = nn.BatchNorm2d(width)
        self.downsample = _shortcut(inputs, width, stride)

    def forward(self, x: Tensor) -> Tensor:
        """See the class."""
        y = self.bn2(self.conv2(F.relu(self.bn1(self.conv1(x)))))
        return F.relu(y + (x if self.downsample is None else self.downsample(x)))


class Bottleneck(nn.Module):
    """1×1, 3×3, 1×1: (B, inputs, h, w) → (B, 4 · width, h / stride, w / stride)."""

    expansion = 4

    def __init__(self, inputs: int, width: int, stride: int) -> None:
        super().__init__()
        self.conv1 = nn.Conv2d(inputs, width, 1, bias=False)
        self.bn1 = nn.BatchNorm2d(width)
        self.conv2 = nn.Conv2d(width, width, 3, stride, 1, bias=False)
        self.bn2 = nn.BatchNorm2d(width)
        self.conv3 = nn.Conv2d(width, 4 * width, 1, bias=False)
        self.bn3 = nn.BatchNorm2d(4 * width)
        self.downsample = _shortcut(inputs, 4 * width, stride)

    def forward(self, x: Tensor) -> Tensor:
        """See the class."""
        y = F.relu(self.bn2(self.conv2(F.relu(self.bn1(self.conv1(x))))))
        return F.relu(self.bn3(self.conv3(y)) + (x if self.downsample is None else self.downsample(x)))


class ResNet(nn.Module):
    """(B, 3, h, w), normalised RGB, sides multiples of 32 → [C2, C3, C4, C5] at strides 4, 8, 16, 32."""

    def __init__(self, name: str) -> None:
        super().__init__()
        block = Bottleneck if name == "r50" else Basic
        self.channels = tuple(width * block.expansion for width in (64, 128, 256, 512))
        self.conv1 = nn.Conv2d(3, 64, 7, 2, 3, bias=False)
        self.bn1 = nn.BatchNorm2d(64)
        inputs = 64
        for nth, depth in enumerate(DEPTHS[name]):
            width, stride = 64 << nth, 1 if nth == 0 else 2
            blocks = [block(inputs, width, stride)]
            inputs = width * block.expansion
            blocks += [block(inputs, width, 1) for _ in range(depth - 1)]
            setattr(self, f"layer{nth + 1}", nn.Sequential(*blocks))

    def stages(self) -> list[list[nn.Module]]:
        """The modules that make C2, C3, C4 and C5, each from the one before."""
        layers = [[getattr(self, f"layer{nth + 1}")] for nth in range(4)]
        return [[self.conv1, self.bn1, *layers[0]], *layers[1:]]

    def forward(self, x: Tensor) -> list[Tensor]:
        """C2…C5, of ``channels`` channels."""
        x = F.max_pool2d(F.relu(self.bn1(self.conv1(x))), 3, 2, 1)
        levels = []
        for nth in range(4):
            x = getattr(self, f"layer{nth + 1}")(x)
            levels.append(x)
        return levels
