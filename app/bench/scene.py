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
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.app.bench.rims import PERCENT, rim_figures, rim_profiles
from fairyring.model.photo import read
from fairyring.model.scene.bed import render_bed
from fairyring.model.scene.presets import PRESETS

HIDDEN, LITTLE = 0.95, 0.6
"""A cap of less than this in sight is partly hidden; of less than that, little is in sight."""
SLACK = 0.25
"""The allowed range is the real photos' least to greatest value, widened by this share of them."""
BEDS = 24
"""Rendered of every preset; fewer differ too much from one another to tell anything of the preset."""
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
    "rim step 10 % (grey levels)": (2.94, 3.34),
    "rim step 25 % (grey levels)": (7.79, 8.54),
    "rim step 50 % (grey levels)": (16.74, 18.16),
    "rim step 75 % (grey levels)": (28.58, 31.92),
    "rim step 90 % (grey levels)": (45.28, 45.56),
    "rim dip 10 % (grey levels)": (-5.68, -5.37),
    "rim dip 25 % (grey levels)": (-0.48, -0.29),
    "rim dip 50 % (grey levels)": (5.3, 5.61),
    "rim dip 75 % (grey levels)": (13.03, 13.64),
    "rim dip 90 % (grey levels)": (24.7, 25.44),
    "rim steepest 10 % (grey levels)": (4.74, 5.45),
    "rim steepest 25 % (grey levels)": (7.28, 7.6),
    "rim steepest 50 % (grey levels)": (11.38, 11.51),
    "rim steepest 75 % (grey levels)": (18.93, 19.04),
    "rim steepest 90 % (grey levels)": (31.11, 34.16),
    "faint rims": (0.27, 0.28),
}
"""Least and greatest figure of the two photos, as ``measure`` and ``rim_figures`` make them."""
RIMS = [name for name in REAL if "rim" in name]


def scene_rows(*, quick: bool, real: Path | None = None) -> list[dict[str, Any]]:
    """The table: each figure of rendered beds and of real photos, and whether it is in the allowed range.

    All figures of preset ``farm``, and those of its rims for ``mixed``.
    """
    ranges = _measure_folder(real) if real else REAL
    beds = 2 if quick else BEDS
    rows = _cost_rows(2 if quick else 6)
    rows += [_compared(name, value, ranges[name]) for name, value in _figures_of("farm", beds).items()]
    for name, value in _figures_of("mixed", beds).items():
        if name in RIMS:
            rows.append(_compared(f"mixed: {name}", value, ranges[name]))
    return rows


def rim_rows(*, quick: bool, real: Path | None = None) -> list[dict[str, Any]]:
    """A row a set of beds, real ones first: quantiles of the figures of its rims."""
    ranges = _measure_folder(real) if real else REAL
    sets = {"real": {name: sum(ranges[name]) / 2 for name in RIMS}}
    for name in ("farm", "mixed", "default", "paper"):
        sets[f"rendered {name}"] = _figures_of(name, 2 if quick else BEDS)
    return [
        {"set": name}
        | {
            kind: " ".join(f"{figures[f'rim {kind} {percent} % (grey levels)']:.0f}" for percent in PERCENT)
            for kind in ("step", "dip", "steepest")
        }
        | {"faint rims": f"{figures['faint rims']:.2f}"}
        for name, figures in sets.items()
    ]


def _compared(name: str, value: float, real: tuple[float, float]) -> dict[str, Any]:
    least, greatest = real
    # A dip may be of either sign, and of a figure about zero a quarter means nothing.
    floor = 1.0 if "rim dip" in name else 0.0
    low = least - max(SLACK * abs(least), floor)
    high = greatest + max(SLACK * abs(greatest), floor)
    return _row(name, value, f"{least:.3g} – {greatest:.3g}", f"{low:.3g} – {high:.3g}", low <= value <= high)


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


@cache
def _figures_of(name: str, count: int) -> Figures:
    """Of so many beds of a preset: the mean of each figure, but of all their rims together."""
    beds = [render_bed(PRESETS[name], seed=1, index=index) for index in range(count)]
    figures = [
        measure(
            bed.image,
            diameters=[cap.diameter for cap in bed.caps],
            fractions=[cap.visible_fraction for cap in bed.caps],
        )
        for bed in beds
    ]
    rims = np.concatenate([rim_profiles(bed.image, [cap.visible for cap in bed.caps]) for bed in beds])
    return {key: float(np.mean([own[key] for own in figures])) for key in figures[0]} | rim_figures(rims)


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
        photo = read(folder / "images" / image["file_name"])
        figures = measure(
            photo,
            diameters=[_diameter(annotation) for annotation in own],
            fractions=[annotation["visible_fraction"] for annotation in own],
        )
        rims = rim_profiles(photo, [annotation["segmentation"] for annotation in own])
        measured.append(figures | rim_figures(rims))
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
