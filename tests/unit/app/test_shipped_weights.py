"""The weights that come with Fairyring, on beds that no training has seen."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import torch

from fairyring.app.bench.network.sets import LabelledPhotos, rendered
from fairyring.app.bench.network.tables import predicted_document
from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.progress import silent
from tests.support.terminal import fairyring

LEAST_AP, LEAST_S50 = 0.75, 0.85
LEAST_FOUND, MOST_CDR = 0.8, 0.5


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> LabelledPhotos:
    return rendered("paper", tmp_path_factory.mktemp("beds"), count=3, progress=silent)


def test_shipped_weights_see_most_caps_of_fresh_beds(beds: LabelledPhotos) -> None:
    predictor = Predictor(load_weights(SHIPPED).network, device=torch.device("cpu"))
    predicted = document_of(predicted_document(predictor.detect, beds))
    figures = evaluate_masks(predicted, document_of(beds.document))
    assert figures["AP"] >= LEAST_AP
    assert figures["S50"] >= LEAST_S50


def test_a_photo_without_a_project_gets_centres_by_them(beds: LabelledPhotos, tmp_path: Path) -> None:
    photo, out = beds.photos[0], tmp_path / "centres.json"
    told = fairyring("predict", photo, "--fast", "--device", "cpu", "--out", out)
    assert told.exit_code == 0, told.output
    document = json.loads(out.read_text())
    assert f"{out}: {len(document['annotations'])} caps in 1 photos" in told.stderr
    assert document["info"]["weights"] == load_weights(SHIPPED).digest
    assert all({"center", "score", "segmentation"} <= cap.keys() for cap in document["annotations"])
    (truth := tmp_path / "truth.json").write_text(json.dumps(beds.document))
    figures = json.loads(fairyring("evaluate", "centres", out, truth, "--json").stdout)
    assert figures["pairing"]["unpredicted"] == [path.name for path in beds.photos[1:]]
    assert figures["matched"] >= LEAST_FOUND * len(document["annotations"])
    assert figures["cdr"]["median"] < MOST_CDR


def test_the_card_beside_the_weights_is_of_these_very_weights() -> None:
    card = SHIPPED.with_suffix(".md").read_text()
    assert f"digest `{load_weights(SHIPPED).digest[:8]}…`" in card
