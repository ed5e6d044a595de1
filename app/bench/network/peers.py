"""Table 1: the network beside methods that need no weights, on the same photos."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.app.bench.network.tables import predicted_document
from fairyring.model.coco.document import document_of
from fairyring.model.colour.methods import METHODS, Found, find_caps
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.photo import Pixels
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import detect_at_its_scale
from fairyring.model.predict.seen import Detection
from fairyring.model.progress import Progress

FIGURES = ("P", "R", "AP", "AP50", "AP75", "S50")
Detect = Callable[[Pixels], Sequence[Detection | Found]]


def peer_rows(
    predictor: Predictor, photos: LabelledPhotos, *, diameter: float | None, progress: Progress
) -> list[dict[str, Any]]:
    """A row for each system; ``seconds`` a photo, on all cores together.

    ``diameter``: how wide most caps are, pixels, for the methods that need no weights; None: they measure it.
    """
    systems: dict[str, Detect] = {"PR-SOLOv2": partial(detect_at_its_scale, predictor)}
    systems |= {method: partial(find_caps, method=method, diameter=diameter) for method in METHODS}
    return [_row(name, detect, photos, progress) for name, detect in systems.items()]


def _row(name: str, detect: Detect, photos: LabelledPhotos, progress: Progress) -> dict[str, Any]:
    began = time.process_time()
    predicted = predicted_document(detect, photos, progress=progress)
    seconds = time.process_time() - began
    figures = evaluate_masks(document_of(predicted), document_of(photos.document))
    shown = {key: None if figures[key] is None else round(figures[key], 4) for key in FIGURES}
    each = round(seconds / len(photos.photos), 2)
    return {"set": photos.name, "system": name, **shown, "cpu_seconds": each}
