"""Table 4: time and memory from a decoded photo to stored centres, stage by stage."""

from __future__ import annotations

import resource
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.model.contour.reconstruct import reconstruct
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import see_at_its_scale
from fairyring.model.predict.seen import Detection
from fairyring.storage.images import find_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project, create_project

WARM_UP, ROUNDS = 2, 7


def cost_rows(predictor: Predictor, photos: LabelledPhotos) -> list[dict[str, Any]]:
    """Medians over the first photo of a set; ratios to the backbone's pass at full resolution."""
    _, photo = next(photos.images())
    device = predictor.device
    reference = timed(lambda: _backbone_alone(predictor, photo), device)
    seen = see_at_its_scale(predictor, photo)
    pieces = predictor.refine(seen)
    found = predictor.tell(seen, pieces)
    times = {
        "network: features, heads": timed(lambda: see_at_its_scale(predictor, photo), device),
        "instances and their edges": timed(lambda: predictor.refine(seen), device),
        "outlines, and whose pixel it is": timed(lambda: predictor.tell(seen, pieces), device),
        "whole outlines and centres": timed(lambda: _centres(found, photo), device),
        "storing": _storing(photos, found),
    }
    masks = times["network: features, heads"] + times["instances and their edges"]
    total = sum(times.values())
    rows = [_row(name, seconds, reference, len(found)) for name, seconds in times.items()]
    rows.append(_row("decoded photo to masks", masks, reference, len(found)))
    rows.append(_row("decoded photo to stored centres", total, reference, len(found)))
    rows.append(_row("reference: the backbone alone, full resolution", reference, reference, len(found)))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    rows.append(
        {"stage": f"peak memory of the process, MB: {peak:.0f}", "ms": None, "ratio": None, "caps": None}
    )
    return rows


def _row(stage: str, seconds: float, reference: float, caps: int) -> dict[str, Any]:
    return {
        "stage": stage,
        "ms": round(1000 * seconds, 1),
        "ratio": round(seconds / reference, 2),
        "caps": caps,
    }


def timed(work: Callable[[], object], device: torch.device) -> float:
    """Median seconds of ROUNDS calls, after WARM_UP ones that do not count; waits for a GPU to finish."""
    times = []
    for _ in range(WARM_UP + ROUNDS):
        _wait(device)
        began = time.perf_counter()
        work()
        _wait(device)
        times.append(time.perf_counter() - began)
    return statistics.median(times[WARM_UP:])


def _wait(device: torch.device) -> None:
    if device.type == "cuda":
        torch.cuda.synchronize()


@torch.inference_mode()
def _backbone_alone(predictor: Predictor, photo: NDArray[np.uint8]) -> object:
    height, width = (side // 32 * 32 for side in photo.shape[:2])
    pixels = torch.from_numpy(photo[:height, :width].copy()).to(predictor.device).permute(2, 0, 1)[None]
    return predictor.network.backbone(pixels.float().contiguous(memory_format=torch.channels_last))


def _centres(found: list[Detection], photo: NDArray[np.uint8]) -> object:
    height, width = photo.shape[:2]
    return reconstruct([cap.outline for cap in found], width=width, height=height)


def _storing(photos: LabelledPhotos, found: list[Detection]) -> float:
    """Median seconds of one transaction that stores predictions."""
    with tempfile.TemporaryDirectory() as folder, create_project(Path(folder) / "project") as project:
        import_paths(project, [photos.photos[0]])
        with project.read() as connection:
            image = find_image(connection, photos.photos[0].name)
        assert image is not None
        times = [_store(project, image.id, found) for _ in range(ROUNDS)]
    return statistics.median(times)


def _store(project: Project, image_id: int, found: list[Detection]) -> float:
    new = [NewPrediction(visible=cap.outline, score=cap.score) for cap in found]

    def work(connection: Any) -> None:
        run = add_run(connection, name="bench", kind="network")
        add_predictions(connection, run_id=run.id, image_id=image_id, predictions=new)

    began = time.perf_counter()
    project.write(work)
    return time.perf_counter() - began
