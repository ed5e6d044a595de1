"""Writes what a project holds into a folder that other programs read."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO

import msgspec
from msgspec import Struct
from sqlalchemy import Connection, func, select

from fairyring.model.garbage import garbage_left_alone
from fairyring.model.processes import worked_on
from fairyring.model.progress import Progress, silent
from fairyring.storage.choices import ExportedPhotos, Only
from fairyring.storage.contents import load_contents, load_numbered_annotations, load_predictions
from fairyring.storage.db import schema
from fairyring.storage.db.rows import image_of
from fairyring.storage.errors import StoreError
from fairyring.storage.exported_photos import write_photos
from fairyring.storage.formats.coco_lines import CapsOfImage, Lines, lines_of, lines_of_packed, packed
from fairyring.storage.formats.coco_results import result_entry, write_results
from fairyring.storage.formats.coco_writing import (
    category_entry,
    image_entry,
    info_entry,
    write_document,
)
from fairyring.storage.project import Project
from fairyring.storage.provenance import origins_of, standing_of
from fairyring.storage.records import Annotation, GivenVerdict, Image, Prediction, Run, is_complete
from fairyring.storage.runs import images_seen_by, latest_runs_of, predictions_by
from fairyring.storage.verdicts import all_verdicts
from fairyring.storage.whole_folders import made_whole

Cap = Annotation | Prediction
Numbered = list[tuple[int, Cap]]
Verdicts = defaultdict[tuple[int, str | None], list[GivenVerdict]]
"""What was said of each image, and of each cap by its uid."""
BESIDE_ANNOTATIONS = 1 << 31
"""Added to the numbers of predictions that are exported beside annotations, which have lower ones."""


WORTH_PROCESSES = 15_000
"""Caps from which several processes are sooner done than this one."""


class Wanted(Struct, frozen=True, kw_only=True):
    """What an export is to hold."""

    only: Only = Only.annotated
    run: Run | None = None
    """The run whose predictions are written; None for the latest of each image."""
    with_ignored: bool = False
    """Keeps ignored caps, as ``iscrowd: 1`` and ``ignored: true``."""
    license: str | None = None
    """Of the whole data set; None for that of its photos."""
    photos: ExportedPhotos = ExportedPhotos.copied
    skip_missing: bool = False
    """Leaves out images whose photo is gone."""


ANNOTATED = Wanted()


class ExportReport(Struct, frozen=True, kw_only=True):
    """How much an export wrote."""

    images: int
    annotations: int
    """How many annotations, or predictions where those were asked for."""
    partial: int
    """Of how many of the images nobody has said that these are all their caps."""
    left_out: list[str]
    """Sentences about images whose file is not the photo that was imported."""
    runs: dict[str, int]
    """The runs whose predictions were written, by name, each with how many images they are of."""
    splits: dict[str, int] = {}
    """Images by the folder of their split, where each has one."""


def export_coco(
    project: Project,
    out: Path,
    wanted: Wanted = ANNOTATED,
    *,
    results: BinaryIO | None = None,
    jobs: int = 1,
    progress: Progress = silent,
) -> ExportReport:
    """Writes ``out/instances.json`` and ``out/images/``; all of it appears at once, or nothing does.

    The state is that of the moment at which the export began; of one state every export is the same, byte for
    byte. Photos are copied as they are; one that is turned by EXIF is written upright, as its coordinates
    are. An image whose file is no longer the photo that was imported is left out, as its labels would go out
    over another photo.

    Args:
        project: whence.
        out: a new or an empty folder.
        wanted: which images, with what of them.
        results: an open file for the predictions as COCO's list of results.
        jobs: how many processes may write the labels.
        progress: called once an image; what it raises ends the export, leaving nothing behind.

    Raises:
        StoreError: ``out`` holds something or cannot be written, a photo is gone, or no image is left.
    """
    with garbage_left_alone(), project.read() as connection, made_whole(out) as folder:
        images = images_of(connection, wanted)
        written = write_set(
            project, connection, images, wanted, folder, results=results, jobs=jobs, progress=progress
        )
        return some_left(written)


def some_left(report: ExportReport) -> ExportReport:
    """The report, unless all images were left out: then StoreError."""
    if report.left_out and not report.images:
        raise StoreError(f"Nothing was exported: {report.left_out[0]}")
    return report


def write_set(
    project: Project,
    connection: Connection,
    images: list[Image],
    wanted: Wanted,
    folder: Path,
    *,
    results: BinaryIO | None = None,
    jobs: int = 1,
    progress: Progress = silent,
) -> ExportReport:
    """Writes these images as one data set into an empty folder. Raises StoreError."""
    only = wanted.only
    hashes, left_out = write_photos(
        project,
        images,
        folder / "images",
        photos=wanted.photos,
        skip_missing=wanted.skip_missing,
        progress=progress,
    )
    images = [image for image in images if image.id in hashes]
    runs = _runs(connection, images, wanted)
    categories = connection.execute(_CATEGORIES).all()
    licenses: list[dict[str, Any]] = []
    verdicts = _verdicts(connection)
    listed = [
        image_entry(
            image,
            sha256=hashes[image.id],
            partial=_is_partial(image, only),
            licenses=licenses,
            verdicts=verdicts[image.id, None],
        )
        for image in images
    ]
    head = {
        "info": info_entry(project.name, standing_of(connection), licenses, license_=wanted.license)
        | _exported(only, runs),
        "licenses": licenses,
        "categories": [category_entry(row.name, row.extra, number=row.id) for row in categories],
        "images": listed,
    }
    numbers = {row.name: row.id for row in categories}
    caps = _caps(connection, images, wanted, progress=progress)
    with (folder / "instances.json").open("wb") as file:
        count = write_document(file, head, _lines(connection, caps, numbers, verdicts, jobs=jobs))
    if results is not None:
        caps = _caps(connection, images, wanted, progress=progress)
        write_results(results, _results(caps, numbers))
    return ExportReport(
        images=len(images),
        annotations=count,
        partial=sum(_is_partial(image, only) for image in images),
        left_out=left_out,
        runs={each.name: seen for each, seen in runs},
    )


_CATEGORIES = select(schema.category).order_by(schema.category.c.id)


def images_of(connection: Connection, wanted: Wanted) -> list[Image]:
    """The images that are wanted, by name."""
    if wanted.run is not None:
        return images_seen_by(connection, wanted.run.id)
    image = schema.image
    which = {
        "annotated": (image.c.status != "new") | (image.c.caps + image.c.ignored > 0),
        "approved": image.c.status == "approved",
        "predicted": image.c.run.is_not(None),
        "all": image.c.id > 0,
    }[wanted.only]
    statement = select(image).where(which).order_by(image.c.sort_name, image.c.id)
    return [image_of(row) for row in connection.execute(statement)]


def _is_partial(image: Image, only: Only) -> bool:
    """Whether nobody has said that what is written of an image are all its caps."""
    return only == "predicted" or not is_complete(image.status)


def _runs(connection: Connection, images: list[Image], wanted: Wanted) -> list[tuple[Run, int]]:
    """The runs whose predictions are written, each with how many of the images they are of."""
    if wanted.run is not None:
        return [(wanted.run, len(images))]
    if wanted.only not in ("predicted", "all"):
        return []
    said = [image.id for image in images if wanted.only == "predicted" or not is_complete(image.status)]
    return latest_runs_of(connection, said)


def _caps(
    connection: Connection, images: list[Image], wanted: Wanted, *, progress: Progress
) -> Iterator[tuple[Image, Numbered]]:
    """The images, and of each the caps with their numbers in the file."""
    load = _loader(connection, wanted)
    for done, image in enumerate(images):
        progress(done, len(images), "Writing labels")
        yield (
            image,
            [
                (number, cap)
                for number, cap in load(image)
                if wanted.with_ignored or not (isinstance(cap, Annotation) and cap.cap.ignored)
            ],
        )


def _loader(connection: Connection, wanted: Wanted) -> Callable[[Image], list[tuple[int, Any]]]:
    run = wanted.run
    if run is not None:
        return lambda image: [(cap.id, cap) for cap in predictions_by(connection, run.id, image.id)]
    if wanted.only == "predicted":
        return lambda image: [(cap.id, cap) for cap in load_predictions(connection, image.id)]
    if wanted.only != "all":
        return lambda image: load_numbered_annotations(connection, image.id)

    def load(image: Image) -> list[tuple[int, Any]]:
        annotations = load_numbered_annotations(connection, image.id)
        if annotations or is_complete(image.status):
            return annotations
        said = load_contents(connection, image.id).predictions
        return [(BESIDE_ANNOTATIONS + cap.id, cap) for cap in said]

    return load


def _verdicts(connection: Connection) -> Verdicts:
    given: Verdicts = defaultdict(list)
    for each in all_verdicts(connection):
        given[each.image, each.annotation].append(each)
    return given


def _lines(
    connection: Connection,
    caps: Iterator[tuple[Image, Numbered]],
    categories: dict[str, int],
    verdicts: Verdicts,
    *,
    jobs: int,
) -> Iterator[Lines]:
    """The annotations of each image as they are written, by so many processes where these are worth it."""
    tasks = (_task(connection, image, numbered, categories, verdicts) for image, numbered in caps)
    if jobs == 1 or (connection.execute(_CAPS).scalar_one() or 0) < WORTH_PROCESSES:
        return map(lines_of, tasks)
    return worked_on(lines_of_packed, map(packed, tasks), jobs=jobs)


_CAPS = select(func.sum(schema.image.c.caps + schema.image.c.predicted))


def _task(
    connection: Connection,
    image: Image,
    numbered: Numbered,
    categories: dict[str, int],
    verdicts: Verdicts,
) -> CapsOfImage:
    annotations = [(number, cap) for number, cap in numbered if isinstance(cap, Annotation)]
    said = {cap.uid: verdicts.get((image.id, cap.uid)) for _, cap in annotations}
    return CapsOfImage(
        size=(image.width, image.height),
        categories=categories,
        annotations=annotations,
        predictions=[(number, cap) for number, cap in numbered if isinstance(cap, Prediction)],
        origins=origins_of(connection, image.id) if annotations else {},
        verdicts={uid: given for uid, given in said.items() if given is not None},
    )


def _results(caps: Iterator[tuple[Image, Numbered]], categories: dict[str, int]) -> Iterator[dict[str, Any]]:
    for image, numbered in caps:
        for _, cap in numbered:
            if isinstance(cap, Prediction):
                size = image.width, image.height
                yield result_entry(cap, size=size, category=categories[cap.category])


def _exported(only: Only, runs: list[tuple[Run, int]]) -> dict[str, Any]:
    """What was exported, for ``info``."""
    listed = [msgspec.to_builtins(run) | {"images": seen} for run, seen in runs]
    return (
        {"exported": only}
        | ({"runs": listed} if runs else {})
        | ({"run": listed[0]} if len(runs) == 1 else {})
    )
