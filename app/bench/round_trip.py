"""How quickly labels come in and go out, by the commands as a person runs them, beside other readers."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from pycocotools.coco import COCO

from fairyring.app.bench.projects import Bed, write_labels
from fairyring.app.bench.serving import FAIRYRING
from fairyring.app.bench.timing import Row, row
from fairyring.model.errors import FairyringError

MEASURED = """
import json, os, subprocess, sys, time
start = time.perf_counter()
running = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(running.pid, 0)
seconds = time.perf_counter() - start
running.returncode = os.waitstatus_to_exitcode(status)
print(json.dumps([seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024]))
sys.exit(running.returncode)
"""
"""Runs a command from a process that has never held much, as what starts it counts as its memory as well."""
DATUMARO = """
import json, sys, time
import datumaro
start = time.perf_counter()
read = datumaro.Dataset.import_from(sys.argv[1], "coco_instances")
len(read)
between = time.perf_counter()
read.export(sys.argv[2], "coco_instances")
print(json.dumps([between - start, time.perf_counter() - between]))
"""


class Ran(NamedTuple):
    """What a command took, from the start of its process to its end."""

    seconds: float
    core_seconds: float
    """Of all cores together, its helpers' too: what other work on the machine changes least."""
    memory: float
    """Of its largest process, MB."""


def round_trip_rows(folder: Path, *, quick: bool) -> list[Row]:
    """Imports and exports beds of 300 caps by the commands, from the start of the process to its end."""
    beds = [
        Bed(name=f"full_{i:04}.jpg", width=1200, height=900, caps=300, vertices=24)
        for i in range(4 if quick else 400)
    ]
    labels, caps = write_labels(folder / "full", beds), 300 * len(beds)
    project, out = folder / "round-trip", folder / "exported"
    _run("init", project)
    imported = _run("import", project, labels, "--link")
    first = _run("export", project, folder / "first", "--labels-only")
    exported = _run("export", project, out, "--labels-only")
    read = _seconds(lambda: json.loads(labels.read_bytes()))
    document: dict[str, Any] = json.loads((out / "instances.json").read_bytes())
    dumped = _seconds(lambda: (folder / "plain.json").write_text(json.dumps(document)))
    rows = [
        row(
            "the command import (reference: json.loads)",
            caps / imported.seconds,
            unit="caps/s",
            target=6000,
            reference=caps / read,
        ),
        row("import: of one core", caps / imported.core_seconds, unit="caps/s"),
        row("import: memory", imported.memory, unit="MB", target=500),
        *_whole_outline_rows(caps, first, exported),
        row(
            "the command export, labels only, afterwards (reference: json.dumps)",
            caps / exported.seconds,
            unit="caps/s",
            target=20_000,
            reference=caps / dumped,
        ),
        row("export: of one core", caps / exported.core_seconds, unit="caps/s"),
        row("export: memory", exported.memory, unit="MB", target=120),
        row("pycocotools reads the export", caps / _seconds(lambda: _read(out)), unit="caps/s"),
    ]
    if importlib.util.find_spec("datumaro") is not None:
        rows += _datumaro_rows(out, caps)
    return rows


def _whole_outline_rows(caps: int, first: Ran, later: Ran) -> list[Row]:
    """What the first export took beyond the later one; no rows where a run was too short to tell."""
    seconds, core_seconds = first.seconds - later.seconds, first.core_seconds - later.core_seconds
    if min(seconds, core_seconds) <= 0:
        return []
    return [
        row("whole outlines, found by the first export", caps / seconds, unit="caps/s"),
        row("whole outlines: of one core", caps / core_seconds, unit="caps/s"),
    ]


def _run(*arguments: object) -> Ran:
    command = [sys.executable, "-c", MEASURED, *FAIRYRING, *map(str, arguments)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if ran.returncode:
        raise FairyringError(f"{arguments[0]} failed: {ran.stderr}")
    return Ran(*json.loads(ran.stdout.splitlines()[-1]))


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _read(out: Path) -> None:
    with contextlib.redirect_stdout(io.StringIO()):
        COCO(out / "instances.json")


def _datumaro_rows(out: Path, caps: int) -> list[Row]:
    """What datumaro takes for the same labels, its own start left out."""
    # It goes by the names of folders and files, and wants one for photos also where there are none.
    given = out.with_name("for-datumaro")
    (given / "images" / "default").mkdir(parents=True)
    (given / "annotations").mkdir()
    (given / "annotations" / "instances_default.json").symlink_to(out / "instances.json")
    command = [sys.executable, "-c", DATUMARO, str(given), str(out.with_name("of-datumaro"))]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if ran.returncode:
        raise FairyringError(f"datumaro failed: {ran.stderr[-500:]}")
    read, written = json.loads(ran.stdout.splitlines()[-1])
    return [
        row("datumaro reads the export", caps / read, unit="caps/s"),
        row("datumaro writes the same", caps / written, unit="caps/s"),
    ]
