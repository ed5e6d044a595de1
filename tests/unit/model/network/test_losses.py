"""The losses against figures worked out by hand."""

from __future__ import annotations

import math

import pytest
import torch

from fairyring.model.network.losses import dice_loss, focal_loss, point_loss


@pytest.mark.parametrize(
    ("logit", "positive", "expected"),
    [
        (0.0, True, 0.25 * 0.5**2 * math.log(2)),
        (0.0, False, 0.75 * 0.5**2 * math.log(2)),
        (math.log(3), True, 0.25 * 0.25**2 * -math.log(0.75)),
        (math.log(3), False, 0.75 * 0.75**2 * -math.log(0.25)),
    ],
)
def test_the_focal_loss_is_that_worked_out_by_hand(logit: float, positive: bool, expected: float) -> None:
    loss = focal_loss(torch.tensor([logit]), torch.tensor([positive]))
    assert float(loss) == pytest.approx(expected, rel=1e-5)


def test_focal_loss_adds_up_over_cells() -> None:
    loss = focal_loss(torch.zeros(5), torch.tensor([True, False, False, False, True]))
    assert float(loss) == pytest.approx((2 * 0.25 + 3 * 0.75) * 0.25 * math.log(2), rel=1e-5)


def test_the_dice_loss_is_that_worked_out_by_hand() -> None:
    sure = torch.tensor([[[40.0, 40.0], [-40.0, -40.0]]])
    quarter = torch.tensor([[[1.0, 0.0], [0.0, 0.0]]])
    assert dice_loss(sure, quarter).tolist() == pytest.approx([1 / 3])
    assert dice_loss(sure, torch.tensor([[[1.0, 1.0], [0.0, 0.0]]])).tolist() == pytest.approx([0], abs=1e-6)
    # p = ½, ½ against q = 1, ½: 1 - 2 · ¾ / (½ + 5/4).
    assert dice_loss(torch.zeros(1, 1, 2), torch.tensor([[[1.0, 0.5]]])).tolist() == pytest.approx([1 / 7])


def test_dice_sums_are_of_full_precision() -> None:
    logits = torch.zeros(1, 200, 200, dtype=torch.bfloat16)
    loss = dice_loss(logits, torch.full((1, 200, 200), 0.5, dtype=torch.bfloat16))
    assert loss.dtype == torch.float32
    assert float(loss) == pytest.approx(0, abs=1e-5)


def test_dice_loss_of_nothing_against_nothing_is_finite() -> None:
    logits = torch.full((1, 4, 4), -100.0, requires_grad=True)
    loss = dice_loss(logits, torch.zeros(1, 4, 4)).sum()
    loss.backward()
    assert torch.isfinite(loss)
    assert logits.grad is not None
    assert torch.isfinite(logits.grad).all()


def test_the_point_loss_is_that_worked_out_by_hand_and_0_without_points() -> None:
    # Soft label ¼ at p = ¾: -(¼ ln ¾ + ¾ ln ¼); label 1 at p = ½: ln 2.
    loss = point_loss(torch.tensor([math.log(3), 0.0]), torch.tensor([0.25, 1.0]))
    first = -(0.25 * math.log(0.75) + 0.75 * math.log(0.25))
    assert float(loss) == pytest.approx((first + math.log(2)) / 2, rel=1e-5)
    assert float(point_loss(torch.zeros(0), torch.zeros(0))) == 0
