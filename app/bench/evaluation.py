"""Time and memory of ``fairyring evaluate``: 120 000 caps against 120 000, as exports write them."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fairyring.app.bench.serving import FAIRYRING
from fairyring.app.bench.timing import Row, row
from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.coco.writing import RECONSTRUCTED, centre_keys, outline_keys, rounded_outline, whole_keys
from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.storage.formats.coco_writing import write_document

WIDTH, HEIGHT = 1920, 1080
ACROSS, DOWN = 20, 12
MOST_MB = 800
PARSE = (sys.executable, "-c", "import json, sys; [json.load(open(path)) for path in sys.argv[1:]]")


def evaluation_rows(*, quick: bool = False) -> list[Row]:
    """Measures both evaluations in processes of their own; the reference parses the files with ``json``."""
    photos = 5 if quick else 500
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as folder:
        truth = _written(Path(folder) / "truth.json", photos, shift=0.0)
        said = _written(Path(folder) / "said.json", photos, shift=1.0)
        parsed_s, parsed_mb = _run(*PARSE, str(said), str(truth))
        caps = f"{photos * ACROSS * DOWN} caps"
        rows = []
        for what in ("centres", "masks"):
            taken_s, most_mb = _run(*FAIRYRING, "evaluate", what, str(said), str(truth), "--json")
            title = f"evaluate {what}, {caps} against as many"
            rows += [
                row(f"{title}: memory", most_mb, unit="MB", target=MOST_MB, reference=parsed_mb),
                row(f"{title}: time (reference: json.load of both)", taken_s, unit="s", reference=parsed_s),
            ]
    return rows


def _run(*command: str) -> tuple[float, float]:
    """Seconds and most resident megabytes of a command; RuntimeError where it failed."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{command} ended with exit code {process.returncode}.")
    # Kilobytes, but on a Mac bytes.
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
    return time.perf_counter() - start, usage.ru_maxrss / unit


def _written(path: Path, photos: int, *, shift: float) -> Path:
    """Circles in a grid, each of its own size, moved ``shift`` px to the right."""
    images = [
        {"id": n, "file_name": f"bed_{n:04}.jpg", "width": WIDTH, "height": HEIGHT}
        for n in range(1, photos + 1)
    ]
    head = {"images": images, "categories": [{"id": 1, "name": DEFAULT_CATEGORY}]}
    with path.open("wb") as file:
        write_document(file, head, ((1, msgspec.json.encode(entry)) for entry in _entries(photos, shift)))
    return path


def _entries(photos: int, shift: float) -> Iterator[dict[str, Any]]:
    random = np.random.default_rng(0)
    for image in range(1, photos + 1):
        for cap in range(ACROSS * DOWN):
            radius = float(random.uniform(15, 0.45 * HEIGHT / DOWN))
            x = (cap % ACROSS + 0.5) * WIDTH / ACROSS + shift
            circle = Circle(x, (cap // ACROSS + 0.5) * HEIGHT / DOWN, radius)
            entry = outline_keys(rounded_outline([polygon_of_shape(circle, chord_error=0.02)]))
            entry |= whole_keys(circle, visible_area=math.pi * radius**2)
            entry |= centre_keys((circle.cx, circle.cy), visibility=RECONSTRUCTED)
            yield {"id": image * 1000 + cap, "image_id": image, "category_id": 1, "iscrowd": 0} | entry
