"""How fast beds are rendered, and how they measure against photos of real ones.

The figures of the real photos are those of two overhead photos of *Agaricus bisporus*, labelled cap by cap;
``real`` measures others: a folder with ``checked.json`` (COCO, with circle or ellipse and
visible_fraction) and ``images/``.
"""

from __future__ import annotations

import json
import multiprocessing
import resource
import sys
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.photo import read
from fairyring.model.scene.bed import render_bed
from fairyring.model.scene.presets import PRESETS
from fairyring.model.scene.settings import Settings

HIDDEN, LITTLE = 0.95, 0.6
"""A cap of less than this in sight is partly hidden; of less than that, little is in sight."""
SLACK = 0.25
"""The allowed range is the real photos' least to greatest value, widened by this share of them."""
LEAST_SPEED, MOST_MEMORY = 2.0, 500.0

Figures = dict[str, float]

REAL: dict[str, tuple[float, float]] = {
    "caps": (244, 250),
    "diameter 10 % (px)": (26.46, 26.72),
    "diameter 50 % (px)": (44.6, 44.76),
    "diameter 90 % (px)": (67.51, 70.63),
    "visible fraction 10 %": (0.315, 0.4819),
    "visible fraction 50 %": (0.9215, 0.9465),
    "visible fraction 90 %": (0.999, 0.999),
    "partly hidden": (0.516, 0.5246),
    "little in sight": (0.1557, 0.256),
    "brightness 10 %": (0, 0),
    "brightness 25 %": (27.33, 28.33),
    "brightness 50 %": (92.67, 111),
    "brightness 75 %": (170.3, 184),
    "brightness 90 %": (199, 210.7),
    "blue over green, bright parts": (1.016, 1.016),
    "red over green, bright parts": (1.009, 1.01),
    "detail 1–2 px (grey levels)": (5.961, 6.99),
    "detail 2–4 px (grey levels)": (7.031, 7.722),
    "detail 4–8 px (grey levels)": (9.161, 9.498),
    "detail 8–16 px (grey levels)": (12.62, 12.63),
}
"""Least and greatest figure of the two photos, as ``measure`` makes them."""


def scene_rows(*, quick: bool, real: Path | None = None) -> list[dict[str, Any]]:
    """The table: each figure of rendered beds and of real photos, and whether it is in the allowed range."""
    ranges = _measure_folder(real) if real else REAL
    beds = 2 if quick else 12
    rendered = [_figures_of_bed(PRESETS["farm"], index) for index in range(beds)]
    rows = _cost_rows(2 if quick else 6)
    for name, (least, greatest) in ranges.items():
        value = float(np.mean([figures[name] for figures in rendered]))
        low, high = least - SLACK * abs(least), greatest + SLACK * abs(greatest)
        rows.append(
            _row(
                name, value, f"{least:.3g} – {greatest:.3g}", f"{low:.3g} – {high:.3g}", low <= value <= high
            )
        )
    return rows


def measure(image: NDArray[np.uint8], *, diameters: list[float], fractions: list[float]) -> Figures:
    """The figures of one bed, given its caps' diameters (px) and the visible fraction of each."""
    size, sight = np.asarray(diameters), np.asarray(fractions)
    figures: Figures = {"caps": float(len(size))}
    for percent in (10, 50, 90):
        figures[f"diameter {percent} % (px)"] = float(np.percentile(size, percent))
    for percent in (10, 50, 90):
        figures[f"visible fraction {percent} %"] = float(np.percentile(sight, percent))
    figures["partly hidden"] = float((sight < HIDDEN).mean())
    figures["little in sight"] = float((sight < LITTLE).mean())
    return figures | _looks(image)


def _looks(image: NDArray[np.uint8]) -> Figures:
    grey = image.mean(axis=2)
    figures = {
        f"brightness {percent} %": float(np.percentile(grey, percent)) for percent in (10, 25, 50, 75, 90)
    }
    bright = image[grey > np.percentile(grey, 75)].mean(axis=0)
    figures["blue over green, bright parts"] = float(bright[0] / bright[1])
    figures["red over green, bright parts"] = float(bright[2] / bright[1])
    # Gradient energy an octave of blur takes away, from the finest on: the spectrum of edges.
    level = grey.astype(np.float32)
    for octave in ("1–2", "2–4", "4–8", "8–16"):
        coarser = cv2.GaussianBlur(level, (0, 0), {"1–2": 1.0, "2–4": 2.0, "4–8": 4.0, "8–16": 8.0}[octave])
        figures[f"detail {octave} px (grey levels)"] = float((level - coarser).std())
        level = coarser
    return figures


def _figures_of_bed(settings: Settings, index: int) -> Figures:
    bed = render_bed(settings, seed=1, index=index)
    return measure(
        bed.image,
        diameters=[cap.diameter for cap in bed.caps],
        fractions=[cap.visible_fraction for cap in bed.caps],
    )


def _cost_rows(count: int) -> list[dict[str, Any]]:
    """Speed and memory, measured in a process of its own: one core, no memory but the renderer's."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        seconds, reference, memory = pool.apply(_cost_of_beds, (count,))
    speed = 1 / seconds
    return [
        _row("images a second a core, 60 caps", speed, None, f"≥ {LEAST_SPEED:g}", speed >= LEAST_SPEED),
        _row("render time over a blur's", seconds / reference, None, None, None),
        _row("memory of a process (MB)", memory, None, f"≤ {MOST_MEMORY:g}", memory <= MOST_MEMORY),
    ]


def _cost_of_beds(count: int) -> tuple[float, float, float]:
    """CPU seconds a bed, those of a wide Gaussian blur of a picture of its size, and peak megabytes."""
    cv2.setNumThreads(1)
    settings = PRESETS["paper"]
    settings = replace(settings, growth=replace(settings.growth, caps=(60, 60)))
    render_bed(settings, seed=2, index=count)
    start = time.process_time()
    for index in range(count):
        render_bed(settings, seed=2, index=index)
    seconds = (time.process_time() - start) / count
    picture = np.zeros((settings.height, settings.width, 3), np.float32)
    start = time.process_time()
    for _ in range(count):
        cv2.GaussianBlur(picture, (0, 0), 4.0)
    reference = (time.process_time() - start) / count
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return seconds, reference, peak / (2**20 if sys.platform == "darwin" else 2**10)


def _measure_folder(folder: Path) -> dict[str, tuple[float, float]]:
    document = json.loads((folder / "checked.json").read_text())
    measured = []
    for image in document["images"]:
        own = [a for a in document["annotations"] if a["image_id"] == image["id"] and not a.get("ignore")]
        measured.append(
            measure(
                read(folder / "images" / image["file_name"]),
                diameters=[_diameter(annotation) for annotation in own],
                fractions=[annotation["visible_fraction"] for annotation in own],
            )
        )
    return {name: (min(m[name] for m in measured), max(m[name] for m in measured)) for name in measured[0]}


def _diameter(annotation: dict[str, Any]) -> float:
    if "circle" in annotation:
        return 2 * annotation["circle"][2]
    return 2 * (annotation["ellipse"][2] * annotation["ellipse"][3]) ** 0.5


def _row(
    figure: str, rendered: float, real: str | None, allowed: str | None, ok: bool | None
) -> dict[str, Any]:
    verdict = None if ok is None else "yes" if ok else "no"
    return {"figure": figure, "rendered": round(rendered, 3), "real": real, "allowed": allowed, "ok": verdict}
