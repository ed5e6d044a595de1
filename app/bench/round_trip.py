"""How quickly labels come in and go out, by the commands as a person runs them, beside other readers."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pycocotools.coco import COCO

from fairyring.app.bench.projects import Bed, write_labels
from fairyring.app.bench.timing import Row, row

FAIRYRING = [sys.executable, "-c", "from fairyring.app.cli import main; main()"]


def round_trip_rows(folder: Path, *, quick: bool) -> list[Row]:
    """Imports and exports beds of 300 caps by the commands, from the start of the process to its end."""
    beds = [
        Bed(name=f"full_{i:04}.jpg", width=1200, height=900, caps=300, vertices=24)
        for i in range(4 if quick else 400)
    ]
    labels, caps = write_labels(folder / "full", beds), 300 * len(beds)
    project, out = folder / "round-trip", folder / "exported"
    _run("init", project)
    imported = _seconds(lambda: _run("import", project, labels, "--link"))
    # Of all processes so far, this is the largest.
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    exported = _seconds(lambda: _run("export", project, out, "--labels-only"))
    document: dict[str, Any] = {}
    parsed = _seconds(lambda: document.update(json.loads((out / "instances.json").read_bytes())))
    dumped = _seconds(lambda: (folder / "plain.json").write_text(json.dumps(document)))
    rows = [
        row(
            "the command import, whole outlines included (reference: json.loads)",
            caps / imported,
            unit="caps/s",
            target=6000,
            reference=caps / parsed,
        ),
        row("its memory", memory, unit="MB", target=500),
        row(
            "the command export, labels only (reference: json.dumps)",
            caps / exported,
            unit="caps/s",
            target=20_000,
            reference=caps / dumped,
        ),
        row("pycocotools reads the export", caps / _seconds(lambda: _read(out)), unit="caps/s"),
    ]
    if importlib.util.find_spec("datumaro") is not None:
        rows.append(row("datumaro reads the export", caps / _seconds(lambda: _datumaro(out)), unit="caps/s"))
    return rows


def _run(*arguments: object) -> None:
    subprocess.run([*FAIRYRING, *map(str, arguments)], check=True, capture_output=True)


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _read(out: Path) -> None:
    with contextlib.redirect_stdout(io.StringIO()):
        COCO(out / "instances.json")


def _datumaro(out: Path) -> None:
    # It goes by the names of folders and files.
    (out / "annotations").mkdir(exist_ok=True)
    (out / "instances.json").replace(out / "annotations" / "instances_default.json")
    program = "import sys, datumaro; len(datumaro.Dataset.import_from(sys.argv[1], 'coco'))"
    subprocess.run([sys.executable, "-c", program, str(out)], check=True, capture_output=True)
