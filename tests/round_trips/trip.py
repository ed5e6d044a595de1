"""An export taken through another tool and back: what became of ids and outlines."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fairyring.model.geometry.likeness import overlaps
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.choices import ExportedPhotos, ImportAs
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.importing.storing import ImportReport
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project, create_project
from fairyring.storage.records import Cap, Edit
from tests.strangers import bed

TOOLS = Path(__file__).parent / "tools"
PACKAGES = {
    "pycocotools": "pycocotools",
    "supervision": "supervision",
    "datasets": "datasets (Hugging Face)",
    "datumaro": "datumaro",
    "labelme": "labelme",
}
"""The packages by the name under which they are imported."""
SCRIPTS = {package: (TOOLS / f"of_{package}.py").read_text() for package in PACKAGES}
"""Read at once, as whoever runs a trip may not be allowed into the folder of the code."""
Document = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Trip:
    """What came back from a tool, against the export that it was given."""

    version: str
    images: tuple[int, int]
    """How many images have the number they had, of how many; the tool's file has it, or none is asked for."""
    categories: tuple[int, int]
    annotations: tuple[int, int]
    """How many caps have the number they had, in what an import into an empty project exports."""
    least_iou: float
    """Of the outlines of one cap before and after."""
    back: ImportReport
    """What the project that it came from says of it."""


class NotInstalledError(Exception):
    """The package is not installed where its script is run."""


def version_of(package: str, *, python: str = sys.executable) -> str:
    """The version of a package for this interpreter. Raises NotInstalledError."""
    ask = f"from importlib.metadata import version; print(version({package!r}))"
    try:
        return _run([python, "-c", ask])
    except subprocess.CalledProcessError as error:
        raise NotInstalledError(package) from error


def _run(command: Sequence[str | Path]) -> str:
    """What a program says that sees nothing of ours."""
    apart = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=apart)
    return done.stdout.strip()


def taken_through(package: str, folder: Path, *, python: str = sys.executable) -> Trip:
    """Makes a project in ``folder``, exports it, has a tool read and write that, and imports it twice.

    Once into an empty project, and once into that which it came from. Raises NotInstalledError.
    """
    version = version_of(package, python=python)
    export, out = folder / "export", folder / "out"
    with create_project(folder / "project") as project:
        _fill(project, folder)
        before = _exported(project, export)
        out.mkdir()
        _run([python, "-c", SCRIPTS[package], export, out])
        labels = sorted(out.glob("*.json"))
        back = import_paths(project, labels, as_=ImportAs.annotations)
    with create_project(folder / "other") as other:
        import_paths(other, [export / "images", *labels], as_=ImportAs.annotations)
        after = _exported(other, folder / "again")
    ious = _ious(before, after)
    return Trip(
        version=version,
        images=_kept(_ids(before, "images", "file_name"), _ids(after, "images", "file_name")),
        categories=_kept(_ids(before, "categories", "name"), _ids(after, "categories", "name")),
        annotations=(sum(one == other for one, other in ious), len(before["annotations"])),
        least_iou=min(ious.values(), default=0.0),
        back=back,
    )


def _fill(project: Project, folder: Path) -> None:
    """Two photos and five caps with numbers of their own: of one part and of two, bare, marked, doubtful."""
    photos = [bed.photo(folder / "photos" / f"bed_{nth}.jpg", moved=30 * nth) for nth in range(2)]
    caps = [
        {"id": 101, "image_id": 7, "segmentation": [bed.flat(bed.circle(0))]},
        {"id": 205, "image_id": 7, "segmentation": [bed.flat(bed.circle(1))], "doubt": True},
        {"id": 33, "image_id": 4, "segmentation": [bed.flat(bed.circle(0))], "circle": [60, 70, 30]},
        {"id": 34, "image_id": 4, "segmentation": _two_parts()},
    ]
    labels = {
        "images": [
            {"id": number, "file_name": photo.name, "width": bed.WIDTH, "height": bed.HEIGHT}
            for number, photo in zip((7, 4), photos, strict=True)
        ],
        "categories": [{"id": 3, "name": "mushroom"}, {"id": 8, "name": "stalk"}],
        "annotations": [cap | {"category_id": 3} for cap in caps],
    }
    import_paths(project, [bed.write(folder / "photos" / "labels.json", labels)])
    # One that a person drew in the editor, which has no number of a file.
    cap = Cap(visible=[[150.0, 20.0, 180.0, 20.0, 180.0, 50.0, 150.0, 50.0]], mark=Circle(165, 35, 18))
    edit = Edit(id="drawn", annotation="drawn", image=7, base=0, cap=cap)
    commit(project, [Derived(edit=edit)], user="ann")


def _two_parts() -> list[list[float]]:
    return [
        [105.0, 80.0, 125.0, 80.0, 125.0, 110.0, 105.0, 110.0],
        [135.0, 80.0, 155.0, 80.0, 155.0, 110.0, 135.0, 110.0],
    ]


def _exported(project: Project, out: Path) -> Document:
    export_coco(project, out, Wanted(photos=ExportedPhotos.copied))
    return json.loads((out / "instances.json").read_text())


def _ids(document: Document, part: str, name: str) -> dict[str, int]:
    return {entry[name]: entry["id"] for entry in document[part]}


def _kept(before: dict[str, int], after: dict[str, int]) -> tuple[int, int]:
    return sum(after.get(name) == number for name, number in before.items()), len(before)


def _ious(before: Document, after: Document) -> dict[tuple[int, int], float]:
    """The IoU of each cap with the one that it is after the trip, by the ids of both."""
    found: dict[tuple[int, int], float] = {}
    for name, number in _ids(before, "images", "file_name").items():
        mine = _of_image(before, number)
        theirs = _of_image(after, _ids(after, "images", "file_name").get(name))
        outlines = [[entry["segmentation"] for entry in entries] for entries in (mine, theirs)]
        shared = overlaps(*outlines, width=bed.WIDTH, height=bed.HEIGHT)
        for nth, entry in enumerate(mine):
            best = max(range(len(theirs)), key=lambda other: shared.get((nth, other), 0.0), default=None)
            if best is not None:
                found[entry["id"], theirs[best]["id"]] = shared.get((nth, best), 0.0)
    return found


def _of_image(document: Document, number: int | None) -> Sequence[Document]:
    return [entry for entry in document["annotations"] if entry["image_id"] == number]
