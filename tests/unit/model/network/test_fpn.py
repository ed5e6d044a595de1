"""The feature pyramid against its sums written out."""

from __future__ import annotations

import torch
from torch.nn import functional as F

from fairyring.model.network.fpn import FeaturePyramid


def test_the_pyramid_is_top_down_sums() -> None:
    torch.manual_seed(0)
    fpn = FeaturePyramid((3, 4, 5, 6), 8)
    c2, c3, c4, c5 = (torch.randn(1, 3 + nth, 16 >> nth, 24 >> nth) for nth in range(4))
    with torch.no_grad():
        p2, p3, p4, p5, p6 = fpn([c2, c3, c4, c5])
        top = fpn.lateral[3](c5)
        fourth = fpn.lateral[2](c4) + top.repeat_interleave(2, 2).repeat_interleave(2, 3)
        third = fpn.lateral[1](c3) + fourth.repeat_interleave(2, 2).repeat_interleave(2, 3)
        second = fpn.lateral[0](c2) + third.repeat_interleave(2, 2).repeat_interleave(2, 3)
        sums = zip((p2, p3, p4, p5), (second, third, fourth, top), strict=True)
        for level, (made, total) in enumerate(sums):
            smooth = fpn.smooth[level]
            torch.testing.assert_close(made, F.conv2d(total, smooth.weight, smooth.bias, padding=1))
    assert p6.shape == (1, 8, 1, 2)
    torch.testing.assert_close(p6, p5[:, :, ::2, ::2])
