"""The losses of Mask R-CNN's two stages."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.objective import Batch
from fairyring.model.peers.anchors import learnt_by, sampled
from fairyring.model.peers.boxes import coded
from fairyring.model.peers.mask_rcnn import (
    BOX_WEIGHTS,
    MASK_GRID,
    PROPOSAL_WEIGHTS,
    MaskRCNN,
    Proposals,
    best_proposals,
)
from fairyring.model.peers.roi_align import roi_align
from fairyring.model.peers.true_caps import TrueCaps, true_caps

PROPOSALS_LEARNT, MOST_CAPS_OF_PROPOSALS = 256, 0.5
BOXES_LEARNT, MOST_CAPS_OF_BOXES = 256, 0.25


def losses_of(network: MaskRCNN, batch: Batch) -> dict[str, Tensor]:
    """The terms of the loss by name, scalars to be added up (section 3.1 of the paper, and Ren et al.)."""
    pyramid = network.pyramid(batch.photos)
    proposals = network.proposals(pyramid)
    terms = [
        _first_stage(proposals, caps) | _second_stage(network, pyramid, proposals, caps)
        for caps in true_caps(batch)
    ]
    return {name: torch.stack([each[name] for each in terms]).mean() for name in terms[0]}


def _first_stage(proposals: Proposals, true: TrueCaps) -> dict[str, Tensor]:
    anchors = proposals.anchors
    learnt = learnt_by(anchors, true.boxes, true.ignored, cap_from=0.7, nothing_below=0.3, each_cap=True)
    caps, nothings = sampled(learnt, count=PROPOSALS_LEARNT, most_caps=MOST_CAPS_OF_PROPOSALS)
    chosen = torch.cat([caps, nothings])
    wanted = (learnt[chosen] >= 0).float()
    likely = F.binary_cross_entropy_with_logits(proposals.likely[true.nth, chosen], wanted)
    codes = coded(true.boxes[learnt[caps]], anchors[caps], weights=PROPOSAL_WEIGHTS)
    placed = F.smooth_l1_loss(proposals.codes[true.nth, caps], codes, beta=1 / 9, reduction="sum")
    return {"proposed": likely, "placed": placed / max(len(chosen), 1)}


def _second_stage(
    network: MaskRCNN, pyramid: list[Tensor], proposals: Proposals, true: TrueCaps
) -> dict[str, Tensor]:
    height, width = true.ignored.shape
    proposed = best_proposals(proposals, true.nth, width=width, height=height)
    # The true boxes are proposed, too, so that there is something to learn from the first iteration on.
    proposed = torch.cat([proposed, true.boxes])
    learnt = learnt_by(proposed, true.boxes, true.ignored, cap_from=0.5, nothing_below=0.5, each_cap=False)
    caps, nothings = sampled(learnt, count=BOXES_LEARNT, most_caps=MOST_CAPS_OF_BOXES)
    chosen = torch.cat([caps, nothings])
    owners = torch.full((len(chosen),), true.nth, device=chosen.device)
    logits, codes = network.score_and_code(pyramid, owners, proposed[chosen])
    wanted = (learnt[chosen] >= 0).float()
    truly = coded(true.boxes[learnt[caps]], proposed[caps], weights=BOX_WEIGHTS)
    placed = F.smooth_l1_loss(codes[: len(caps)], truly, reduction="sum")
    return {
        "cap": F.binary_cross_entropy_with_logits(logits, wanted),
        "box": placed / max(len(chosen), 1),
        "mask": _mask_loss(network, pyramid, true, boxes=proposed[caps], caps=learnt[caps]),
    }


def _mask_loss(
    network: MaskRCNN, pyramid: list[Tensor], true: TrueCaps, *, boxes: Tensor, caps: Tensor
) -> Tensor:
    """Mean cross-entropy of the masks of boxes (n, 4) that learn these caps (n,); 0 without any."""
    if not len(boxes):
        return pyramid[0].sum() * 0
    owners = torch.full((len(boxes),), true.nth, device=boxes.device)
    logits = network.mask_logits(pyramid, owners, boxes)
    truly = roi_align(true.masks[:, None].float(), caps, boxes, size=2 * MASK_GRID, stride=1)[:, 0]
    return F.binary_cross_entropy_with_logits(logits, (truly >= 0.5).float())
