"""The ResNets against torchvision's: names, shapes and numbers of parameters."""

from __future__ import annotations

import pytest
import torch

from fairyring.model.network.backbone import load_backbone
from fairyring.model.network.resnet import ResNet

TENSORS = {
    "r18": {
        "conv1.weight": (64, 3, 7, 7),
        "bn1.running_mean": (64,),
        "layer1.0.conv1.weight": (64, 64, 3, 3),
        "layer1.1.bn2.bias": (64,),
        "layer2.0.downsample.0.weight": (128, 64, 1, 1),
        "layer2.0.downsample.1.running_var": (128,),
        "layer4.1.conv2.weight": (512, 512, 3, 3),
    },
    "r34": {"layer3.5.conv2.weight": (256, 256, 3, 3), "layer4.2.bn2.num_batches_tracked": ()},
    "r50": {
        "layer1.0.conv1.weight": (64, 64, 1, 1),
        "layer1.0.conv3.weight": (256, 64, 1, 1),
        "layer1.0.downsample.0.weight": (256, 64, 1, 1),
        "layer2.0.conv1.weight": (128, 256, 1, 1),
        "layer3.5.conv2.weight": (256, 256, 3, 3),
        "layer4.2.bn3.weight": (2048,),
    },
}
# torchvision's counts (11 689 512, 21 797 672, 25 557 032), less those of the classifier.
PARAMETERS = {"r18": 11_176_512, "r34": 21_284_672, "r50": 23_508_032}
ENTRIES = {"r18": 120, "r34": 216, "r50": 318}


@pytest.mark.parametrize("name", TENSORS)
def test_names_shapes_and_counts_are_torchvisions(name: str) -> None:
    with torch.device("meta"):
        network = ResNet(name)
    state = network.state_dict()
    assert {key: tuple(state[key].shape) for key in TENSORS[name]} == TENSORS[name]
    assert sum(value.numel() for value in network.parameters()) == PARAMETERS[name]
    assert len(state) == ENTRIES[name]


def test_a_classifiers_state_dict_loads_without_its_classifier() -> None:
    torch.manual_seed(0)
    state = {key: torch.rand_like(value.float()) for key, value in ResNet("r18").state_dict().items()}
    backbone = ResNet("r18")
    load_backbone(backbone, state | {"fc.weight": torch.zeros(1000, 512), "fc.bias": torch.zeros(1000)})
    torch.testing.assert_close(backbone.layer4[1].bn2.weight.data, state["layer4.1.bn2.weight"])


@pytest.mark.parametrize(
    ("name", "channels"), [("r18", (64, 128, 256, 512)), ("r50", (256, 512, 1024, 2048))]
)
def test_levels_have_their_strides(name: str, channels: tuple[int, ...]) -> None:
    with torch.inference_mode():
        levels = ResNet(name).eval()(torch.zeros(1, 3, 64, 96))
    assert [tuple(level.shape) for level in levels] == [
        (1, count, 16 >> nth, 24 >> nth) for nth, count in enumerate(channels)
    ]


def test_the_three_by_three_convolution_strides() -> None:
    with torch.device("meta"):
        block = ResNet("r50").layer2[0]
    assert (block.conv1.stride, block.conv2.stride, block.conv3.stride) == ((1, 1), (2, 2), (1, 1))
