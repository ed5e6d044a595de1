"""How YOLACT mixes prototypes."""

from __future__ import annotations

import torch

from fairyring.model.peers.yolact import PROTOTYPES, YOLACT, mixed
from tests.support.small_networks import TINY


def test_a_mask_is_the_sum_of_prototypes_each_times_its_share() -> None:
    generator = torch.Generator().manual_seed(1)
    prototypes, mixtures = torch.randn(3, 2, 4, generator=generator), torch.randn(2, 3, generator=generator)
    found = mixed(prototypes, mixtures)
    for nth in range(2):
        expected = sum(float(mixtures[nth, k]) * prototypes[k] for k in range(3))
        assert torch.allclose(found[nth], expected, atol=1e-6)


def test_every_anchor_has_a_word_a_box_and_a_mixture() -> None:
    network = YOLACT(TINY).eval()
    with torch.inference_mode():
        said = network(torch.zeros(2, 3, 64, 96, dtype=torch.uint8))
    # Strides of 8, 16, 32, 64 and 128 photo pixels, three anchors a cell.
    cells = 8 * 12 + 4 * 6 + 2 * 3 + 1 * 2 + 1 * 1
    assert said.likely.shape == (2, 3 * cells, 2)
    assert said.codes.shape == (2, 3 * cells, 4)
    assert said.mixtures.shape == (2, 3 * cells, PROTOTYPES)
    assert said.prototypes.shape == (2, PROTOTYPES, 64 // network.mask_stride, 96 // network.mask_stride)
    assert said.mixtures.abs().max() <= 1
