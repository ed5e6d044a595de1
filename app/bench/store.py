"""How the store, and the server over it, do in a project of 10 000 images and 500 000 caps.

Each figure stands beside a plain reference of the same run: the same rows read, or written and synced,
by bare ``sqlite3``; the same file parsed by ``json``.
"""

from __future__ import annotations

import json
import sqlite3
import tempfile
import time
import uuid
from pathlib import Path

import numpy as np

from fairyring.app.bench.browser.leafing import leaf, measured_tab
from fairyring.app.bench.browser.tab import chromium
from fairyring.app.bench.plain import synced_inserts
from fairyring.app.bench.projects import Bed, write_labels
from fairyring.app.bench.round_trip import round_trip_rows
from fairyring.app.bench.serving import served
from fairyring.app.bench.timing import Row, milliseconds, p95_row, row
from fairyring.app.caps.whole_outlines import derive_edits
from fairyring.storage.contents import load_contents
from fairyring.storage.folder import DATABASE
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.project import Project, create_project
from fairyring.storage.records import Cap, Edit, ImageContents


def store_rows(*, quick: bool = False) -> list[Row]:
    """Measures import, list, open, edit and leafing through, in a temporary folder (about 1.5 GB)."""
    count, leafed = (100, 3) if quick else (10_000, 100)
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as folder:
        labels = write_labels(Path(folder) / "photos", _beds(count))
        with create_project(Path(folder) / "project") as project:
            rows = [_import(project, labels)]
            opened = _contents(project, count)
            rows += [
                _list(project, count),
                _open(project, [contents.image.id for contents in opened]),
                _edit(project, opened, Path(folder)),
            ]
        rows += round_trip_rows(Path(folder), quick=quick)
        return rows + _leaf_through(Path(folder) / "project", leafed)


def _beds(count: int) -> list[Bed]:
    return [Bed(name=f"bed_{i:05}.jpg", width=320, height=240, caps=50, vertices=20) for i in range(count)]


def _import(project: Project, labels: Path) -> Row:
    photos = sorted(labels.parent.glob("*.jpg"))
    import_paths(project, photos, link=True)
    start = time.perf_counter()
    count = len(json.loads(labels.read_bytes())["annotations"])
    parsed_in = time.perf_counter() - start
    start = time.perf_counter()
    report = import_paths(project, [labels])
    taken = time.perf_counter() - start
    assert report.annotations == count, report.problems
    return row(
        "import of COCO, validation included, whole outlines not (reference: json.loads)",
        count / taken,
        unit="annotations/s",
        target=5000,
        reference=count / parsed_in,
    )


def _contents(project: Project, count: int) -> list[ImageContents]:
    ids = np.random.default_rng(1).choice(np.arange(1, count + 1), size=100, replace=False)
    with project.read() as connection:
        return [load_contents(connection, int(image_id)) for image_id in ids]


def _list(project: Project, count: int) -> Row:
    filters = [
        ImageFilter(),
        ImageFilter(search="77"),
        ImageFilter(sort="caps", descending=True),
        ImageFilter(sort="cdr", descending=True),
        ImageFilter(status="annotated", annotated=True),
    ]
    pages = [(which, offset) for which in filters for offset in range(0, count, max(1, count // 10))]

    def page(wanted: tuple[ImageFilter, int]) -> None:
        with project.read() as connection:
            list_images(connection, wanted[0], offset=wanted[1], limit=50)

    with sqlite3.connect(project.folder / DATABASE) as plain:
        query = "SELECT * FROM image ORDER BY sort_name LIMIT 50 OFFSET ?"
        reference = milliseconds(lambda wanted: plain.execute(query, (wanted[1],)).fetchall(), pages)
    return p95_row(
        "a page of the list (reference: bare SELECT)",
        milliseconds(page, pages),
        target=100,
        reference=reference,
    )


def _open(project: Project, ids: list[int]) -> Row:
    def open_image(image_id: int) -> None:
        with project.read() as connection:
            load_contents(connection, image_id)

    with sqlite3.connect(project.folder / DATABASE) as plain:
        query = "SELECT * FROM annotation WHERE image = ? AND deleted = 0"
        reference = milliseconds(lambda image_id: plain.execute(query, (image_id,)).fetchall(), ids)
    taken = milliseconds(open_image, ids)
    return p95_row("open an image (reference: bare SELECT)", taken, target=50, reference=reference)


def _edit(project: Project, opened: list[ImageContents], folder: Path) -> Row:
    edits = [_moved(contents) for contents in opened]

    def save(edit: Edit) -> None:
        commit(project, derive_edits(project, [edit]), user="bench")

    reference = synced_inserts(folder / "plain.db", payload=json.dumps(edits[0].cap and edits[0].cap.visible))
    return p95_row(
        "an edit worked out and on disk (reference: one synced INSERT)",
        milliseconds(save, edits),
        target=50,
        reference=reference,
    )


def _leaf_through(project: Path, count: int) -> list[Row]:
    with chromium() as browser, served(project) as server, measured_tab(browser, server) as tab:
        waited = [leaf(tab) for _ in range(count)]
        memory = row(f"server memory after {count} images", server.memory_mb(), unit="MB", target=500)
    return [p95_row("next image, 320 × 240", waited, target=100), memory]


def _moved(contents: ImageContents) -> Edit:
    annotation = contents.annotations[0]
    visible = [[value + 0.25 for value in part] for part in annotation.cap.visible]
    return Edit(
        id=uuid.uuid4().hex,
        annotation=annotation.uid,
        image=contents.image.id,
        base=annotation.revision,
        cap=Cap(visible=visible),
    )
