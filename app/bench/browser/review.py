"""How long it takes to correct a whole bed, from the shipped predictions on.

A scripted annotator does it in Chromium. Its inputs are counted, and what they take a person is worked out by
the keystroke-level model (``hand.py``). The machine's own time is that of the same inputs when nobody thinks
or aims.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from msgspec.structs import replace
from playwright.sync_api import Browser

from fairyring.app.bench.browser.annotator import Annotator
from fairyring.app.bench.browser.hand import DECIDE_S
from fairyring.app.bench.browser.leafing import measured_tab
from fairyring.app.bench.browser.tab import chromium
from fairyring.app.bench.serving import served
from fairyring.app.bench.timing import Row, row
from fairyring.app.jobs.finders import network_of
from fairyring.app.jobs.predicting import predict_images
from fairyring.model.coco.document import read_document
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.geometry.shapes import Outline, area_of_outline
from fairyring.model.json_files import read_json
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.scene.dataset import DOCUMENT, write_beds
from fairyring.model.scene.presets import preset
from fairyring.storage.choices import ExportedPhotos, Only
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project, open_project

LEAST_AREA = 50.0
"""Of what shows less than this, px² (a disc 8 px wide), nobody draws the outline."""


@dataclass(frozen=True, kw_only=True)
class Task:
    """A bed to correct."""

    preset: str
    caps: int
    target_s: float | None


TASKS = (Task(preset="paper", caps=60, target_s=120), Task(preset="farm", caps=214, target_s=None))
QUICK = (Task(preset="paper", caps=8, target_s=None),)
SEED = 3005
"""From here on seeds are of no bed that the network was trained, validated or tested on."""


def review_rows(*, quick: bool = False, seed: int = SEED) -> list[Row]:
    """For each bed a person's time, the machine's, inputs by kind, and the quality before and after."""
    with chromium() as browser:
        return [line for task in (QUICK if quick else TASKS) for line in _corrected(browser, task, seed)]


def _corrected(browser: Browser, task: Task, seed: int) -> list[Row]:
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as name:
        folder = Path(name)
        truth = _predicted_bed(folder, task, seed)
        before = _quality(folder, Only.predicted)
        with served(folder / "project") as server, measured_tab(browser, server) as tab:
            annotator = Annotator(tab, truth)
            began = time.perf_counter()
            annotator.correct()
            machine_s = time.perf_counter() - began
        after = _quality(folder, Only.annotated)
    done = annotator.hand.done
    what = f"{task.caps} caps"
    return [
        row(f"{what}: a person's time", done.seconds, unit="s", target=task.target_s),
        row(f"{what}: with a decision on every cap", done.seconds + DECIDE_S * len(truth), unit="s"),
        row(f"{what}: the machine's own time for these inputs", machine_s, unit="s"),
        row(f"{what}: inputs", done.count, unit=""),
        row(f"{what}: pressed keys, those pressed together once", done.presses, unit=""),
        row(f"{what}: clicks", done.clicks, unit=""),
        row(f"{what}: strokes", done.strokes, unit=""),
        row(f"{what}: drawn along", done.traced_px, unit="px"),
        row(f"{what}: aimed at", done.points, unit=""),
        row(f"{what}: decisions", done.decisions, unit=""),
        *(row(f"{what}: {key} after (before)", after[key], unit="", reference=before[key]) for key in before),
    ]


def _predicted_bed(folder: Path, task: Task, seed: int) -> list[Outline]:
    """A project of one rendered bed with its predictions; returns what its caps show."""
    settings = preset(task.preset)
    settings = replace(settings, growth=replace(settings.growth, caps=(task.caps, task.caps)))
    write_beds(folder / "bed", settings, count=1, seed=seed)
    with create_project(folder / "project") as project:
        import_paths(project, [folder / "bed" / "images"])
        predict_images(project, network_of(SHIPPED), [1])
    caps: list[dict[str, Any]] = read_json(folder / "bed" / DOCUMENT)["annotations"]
    return [cap["segmentation"] for cap in caps if area_of_outline(cap["segmentation"]) >= LEAST_AREA]


def _quality(folder: Path, only: Only) -> dict[str, float]:
    """What is in the store, measured against all caps of the bed."""
    out = folder / only.value
    with open_project(folder / "project") as project:
        export_coco(project, out, Wanted(only=only, photos=ExportedPhotos.none))
    found = evaluate_masks(read_document(out / DOCUMENT), read_document(folder / "bed" / DOCUMENT))
    return {name: found[name] for name in ("AP", "S50", "S75")}
