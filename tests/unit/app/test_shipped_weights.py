"""The weights that come with Fairyring, on beds that no training has seen."""

from __future__ import annotations

from pathlib import Path

import torch

from fairyring.app.bench.network.sets import rendered
from fairyring.app.bench.network.tables import predicted_document
from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.progress import silent

LEAST_AP, LEAST_S50 = 0.75, 0.85


def test_shipped_weights_see_most_caps_of_fresh_beds(tmp_path: Path) -> None:
    beds = rendered("paper", tmp_path, count=3, progress=silent)
    predictor = Predictor(load_weights(SHIPPED).network, device=torch.device("cpu"))
    predicted = document_of(predicted_document(predictor.detect, beds))
    figures = evaluate_masks(predicted, document_of(beds.document))
    assert figures["AP"] >= LEAST_AP
    assert figures["S50"] >= LEAST_S50


def test_the_card_beside_the_weights_is_of_these_very_weights() -> None:
    card = SHIPPED.with_suffix(".md").read_text()
    assert f"digest `{load_weights(SHIPPED).digest[:8]}…`" in card
