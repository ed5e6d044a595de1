"""Exports started in the app: a data set made in the project's cache folder, and offered as a zip file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from uuid import uuid4
from zipfile import ZIP_STORED, ZipFile

from fairyring.app.addresses import download_address
from fairyring.app.caps.filling_in import fill_in, one_by_one
from fairyring.app.jobs.runner import Result
from fairyring.app.workers.crew import Run, here
from fairyring.model.progress import Progress
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.project import Project
from fairyring.storage.whole_folders import temporary_folder

KEPT = 3
"""How many zip files stay in the cache."""


def exports_folder(project: Project) -> Path:
    """The folder of the zip files."""
    return project.cache / "exports"


def export_work(project: Project, wanted: Wanted, *, run: Run = here) -> Callable[[Progress], Result]:
    """The work of an export job: whole outlines that are missing, the data set, the zip file."""

    def work(progress: Progress) -> Result:
        fill_in(project, compute=one_by_one(run), progress=progress)
        exports = exports_folder(project)
        exports.mkdir(parents=True, exist_ok=True)
        with temporary_folder(exports) as folder:
            report = export_coco(project, folder / "coco", wanted, progress=progress)
            packed, made = folder / "coco.zip", exports / f"{uuid4().hex}.zip"
            _zip(folder / "coco", packed, progress)
            packed.replace(made)
        _drop_old(exports)
        said = f"{report.images} images, {report.annotations} annotations.{predictions_of(report.runs)}"
        message = " ".join([said, *report.left_out])
        return Result(message, link=download_address(made.name))

    return work


def predictions_of(runs: Mapping[str, int]) -> str:
    """Of which runs predictions were written, as a sentence after another; nothing where none were."""
    listed = ", ".join(f"{name} ({seen} image{'' if seen == 1 else 's'})" for name, seen in runs.items())
    return f" Predictions of {listed}." if runs else ""


def _zip(folder: Path, made: Path, progress: Progress) -> None:
    """Zips a folder without compressing: photos are compressed already."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    with ZipFile(made, "w", ZIP_STORED) as archive:
        for done, file in enumerate(files):
            progress(done, len(files), "Packing")
            archive.write(file, file.relative_to(folder))


def _drop_old(exports: Path) -> None:
    newest_first = sorted(exports.glob("*.zip"), key=lambda file: file.stat().st_mtime, reverse=True)
    for file in newest_first[KEPT:]:
        file.unlink(missing_ok=True)
