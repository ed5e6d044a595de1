"""The log of a training: a line of JSON for each event, and curves drawn from it."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

LOG, CURVES = "log.jsonl", "curves.png"
SMOOTH = 25
"""Iterations over which the losses' curves are averaged."""
TERMS = ("category", "mask", "points", "quality", "whole")
"""The terms of a loss that are drawn where they are logged."""


def append(folder: Path, entries: Iterable[dict[str, Any]]) -> None:
    """Adds events to the log."""
    with (folder / LOG).open("a") as file:
        file.writelines(json.dumps(entry) + "\n" for entry in entries)


def read(folder: Path) -> list[dict[str, Any]]:
    """All events so far; a line that was cut off by a kill is left out."""
    path = folder / LOG
    entries = []
    for line in path.read_text().splitlines() if path.exists() else []:
        try:
            entries.append(json.loads(line))
        except json.JSONDecodeError:
            continue
    return entries


def cut_after(folder: Path, iteration: int) -> None:
    """Drops the entries after ``iteration``: a training that goes on from there writes them again."""
    kept = [entry for entry in read(folder) if entry["iteration"] <= iteration]
    (folder / LOG).write_text("".join(json.dumps(entry) + "\n" for entry in kept))


def draw_curves(folder: Path) -> None:
    """Losses and validation figures over the iterations, as a PNG beside the log."""
    entries = read(folder)
    steps = [entry for entry in entries if "rate" in entry]
    checks = [entry for entry in entries if "AP" in entry]
    figure = Figure(figsize=(10, 4), layout="constrained")
    losses, figures = figure.subplots(1, 2)
    for term in [term for term in TERMS if all(term in step for step in steps)]:
        losses.plot([s["iteration"] for s in steps], _smoothed([s[term] for s in steps]), label=term)
    for name in ("AP", "AP50", "AP75", "S50"):
        known = [check for check in checks if name in check]
        figures.plot([c["iteration"] for c in known], [c[name] for c in known], "o-", label=name)
    for axes, title in ((losses, f"losses, mean of {SMOOTH} iterations"), (figures, "validation")):
        axes.set(xlabel="iteration", title=title)
        axes.grid(alpha=0.3)
        axes.legend()
    figures.set_ylim(0, 1)
    figure.savefig(folder / CURVES, dpi=110)


def _smoothed(values: list[float]) -> list[float]:
    """Each value's mean with those before it."""
    sums = np.cumsum([0.0, *values])
    ends = np.arange(1, len(values) + 1)
    starts = np.maximum(ends - SMOOTH, 0)
    return ((sums[ends] - sums[starts]) / (ends - starts)).tolist()
