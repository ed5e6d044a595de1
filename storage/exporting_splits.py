"""Writes a data set a split: ``train/``, ``val/`` and ``test/``, each as an export of its own."""

from __future__ import annotations

from collections import Counter, defaultdict
from pathlib import Path

from fairyring.model.progress import Progress, silent
from fairyring.model.splits import Split, split_called
from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import ExportReport, Wanted, images_of, some_left, write_set
from fairyring.storage.project import Project
from fairyring.storage.records import Image
from fairyring.storage.whole_folders import made_whole


def export_splits(
    project: Project, out: Path, wanted: Wanted, *, jobs: int = 1, progress: Progress = silent
) -> ExportReport:
    """Writes ``out/train/instances.json``, ``out/train/images/`` and so on for the splits that have images.

    Images of no split are in ``train``, as a training takes them. Else as ``export_coco``.

    Raises:
        StoreError: as there; or an image is in a split that is none of ours.
    """
    with project.read() as connection, made_whole(out) as folder:
        images: defaultdict[Split, list[Image]] = defaultdict(list)
        for image in images_of(connection, wanted):
            images[_split_of(image)].append(image)
        if not images:
            images[Split.train] = []
        reports: dict[Split, ExportReport] = {}
        for split in sorted(images, key=list(Split).index):
            (folder / split).mkdir()
            reports[split] = write_set(
                project, connection, images[split], wanted, folder / split, jobs=jobs, progress=progress
            )
        return some_left(_joined(reports))


def _split_of(image: Image) -> Split:
    if image.split is None:
        return Split.train
    split = split_called(image.split)
    if split is None:
        raise StoreError(
            f"{image.file_name} is in the split {image.split}, which has no folder; "
            f"put it into one of {', '.join(Split)} with fairyring split."
        )
    return split


def _joined(reports: dict[Split, ExportReport]) -> ExportReport:
    runs: Counter[str] = Counter()
    for report in reports.values():
        runs.update(report.runs)
    return ExportReport(
        images=sum(report.images for report in reports.values()),
        annotations=sum(report.annotations for report in reports.values()),
        partial=sum(report.partial for report in reports.values()),
        left_out=[sentence for report in reports.values() for sentence in report.left_out],
        runs=dict(runs),
        splits={split: report.images for split, report in reports.items()},
    )
