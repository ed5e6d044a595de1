"""Tables 2 and 3: PR-SOLOv2 beside SOLOv2, Mask R-CNN and YOLACT, all trained alike on the same beds."""

from __future__ import annotations

import multiprocessing
import resource
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import torch

from fairyring.app.bench.network.ablation import PAPER_SOLOV2, trained_variant, variants
from fairyring.app.bench.network.sets import LabelledPhotos, examples_of, rendered_for_training
from fairyring.app.bench.network.tables import PAPER_MASKS, predicted_document
from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.network.weights import load_weights
from fairyring.model.peers.detecting import detect
from fairyring.model.peers.training import PEERS, trained_peer
from fairyring.model.photo import Pixels
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection
from fairyring.model.progress import Progress
from fairyring.model.train.recipe import Recipe

OURS = {"SOLOv2": "SOLOv2, soft targets", "PR-SOLOv2": "PR-SOLOv2 (A), soft targets"}
"""The variants of the ablation that stand for the paper's two systems."""
FIGURES = ("P", "R", "AP", "AP50", "AP75", "S50")
PAPER: dict[str, dict[str, float]] = {
    "Mask R-CNN": {"P": 0.933, "R": 0.852, "AP": 0.8351, "AP50": 0.9506, "AP75": 0.8901, "S50": 0.8612},
    "YOLACT": {"P": 0.901, "R": 0.838, "AP": 0.8074, "AP50": 0.9345, "AP75": 0.8785, "S50": 0.8038},
    "SOLOv2": {"P": 0.959, "R": 0.917, "AP50": 0.9610, "AP75": 0.9275, "S50": 0.9062} | PAPER_SOLOV2,
    "PR-SOLOv2": {"P": 0.982, "R": 0.945} | PAPER_MASKS,
}
"""Tables 2 and 3 of the paper: real photos of its own, thousands of iterations on a GPU."""


class Measured(NamedTuple):
    """One system's predictions for a set of photos, and what they cost."""

    predicted: dict[str, Any]
    seconds: float
    """Of the processor, a photo."""
    megabytes: float
    """Peak memory of a process that does nothing else."""
    millions: float
    """Parameters of the network."""


def alike_rows(
    *,
    folder: Path,
    sets: list[LabelledPhotos],
    beds: int,
    iterations: int,
    crop: int,
    device: torch.device,
    progress: Progress,
) -> list[dict[str, Any]]:
    """Trains each system in ``folder``, going on with what is there, and measures it on every set.

    All have the same backbone, see the same ``beds`` of each preset and the same crops of ``crop`` pixels,
    for as many iterations, by the same optimiser and seed.
    """
    recipes = variants(iterations=iterations, crop=crop)
    examples = [
        example for photos in rendered_for_training(folder, beds, progress) for example in examples_of(photos)
    ]
    rows = [
        {"set": "the paper's", "system": name} | {key: figures.get(key) for key in FIGURES}
        for name, figures in PAPER.items()
    ]
    for name in (*PEERS, *OURS):
        recipe = recipes[OURS["PR-SOLOv2"]]
        if name in PEERS:
            out = folder / f"{iterations} {name}".replace(" ", "_")
            trained_peer(name, examples, out, recipe=recipe, device=device, progress=progress)
        else:
            recipe = recipes[OURS[name]]
            out = trained_variant(
                OURS[name], recipe, examples, folder=folder, device=device, progress=progress
            )
        for photos in sets:
            rows.append({"set": photos.name, "system": name} | _figures(name, out, recipe, photos, device))
    return rows


def _figures(
    name: str, out: Path, recipe: Recipe, photos: LabelledPhotos, device: torch.device
) -> dict[str, Any]:
    # A process of its own: the peak of its memory is then this system's alone.
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        measured = pool.submit(measure, name, out, recipe, photos, device=str(device)).result()
    figures = evaluate_masks(document_of(measured.predicted), document_of(photos.document))
    shown = {key: None if figures[key] is None else round(figures[key], 4) for key in FIGURES}
    return shown | {
        "cpu_seconds": round(measured.seconds, 2),
        "peak_MB": round(measured.megabytes),
        "parameters_M": round(measured.millions, 2),
    }


def measure(name: str, out: Path, recipe: Recipe, photos: LabelledPhotos, *, device: str) -> Measured:
    """The predictions of the system that was trained in ``out``; to be called in a process of its own."""
    detecting, network = _system(name, out, recipe, device=torch.device(device))
    began = time.process_time()
    predicted = predicted_document(detecting, photos)
    return Measured(
        predicted=predicted,
        seconds=(time.process_time() - began) / len(photos.photos),
        megabytes=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        millions=sum(parameter.numel() for parameter in network.parameters()) / 1e6,
    )


def _system(
    name: str, out: Path, recipe: Recipe, *, device: torch.device
) -> tuple[Callable[[Pixels], list[Detection]], torch.nn.Module]:
    if name in PEERS:
        peer = trained_peer(name, [], out, recipe=recipe, device=device)
        return partial(detect, network=peer), peer
    network = load_weights(out / "weights.safetensors").network
    return Predictor(network, device=device).detect, network
