"""Writes what a project holds into a folder that other programs read."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import msgspec
from msgspec import Struct
from sqlalchemy import Connection, func, select

from fairyring.model.garbage import garbage_left_alone
from fairyring.model.processes import worked_on
from fairyring.model.progress import Progress, silent
from fairyring.storage.choices import ExportedPhotos, Only
from fairyring.storage.contents import load_predictions
from fairyring.storage.db import schema
from fairyring.storage.db.rows import image_of
from fairyring.storage.errors import StoreError
from fairyring.storage.exported_photos import write_photos
from fairyring.storage.formats.coco_lines import Lines, lines_of, packed
from fairyring.storage.formats.coco_results import result_entry, write_results
from fairyring.storage.formats.coco_writing import (
    category_entry,
    image_entry,
    info_entry,
    write_document,
)
from fairyring.storage.project import Project
from fairyring.storage.provenance import standing_of
from fairyring.storage.records import GivenVerdict, Image, Run, is_complete
from fairyring.storage.runs import images_seen_by, latest_runs_of, predictions_by
from fairyring.storage.stored_caps import (
    stored_annotations,
    stored_open_predictions,
    stored_predictions,
    without_ignored,
)
from fairyring.storage.verdicts import all_verdicts
from fairyring.storage.whole_folders import made_whole

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


class _Verdicts(NamedTuple):
    """What reviewers said, by image."""

    on_images: dict[int, list[GivenVerdict]]
    on_caps: dict[int, dict[str, list[GivenVerdict]]]
    """By the uid of the cap."""


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
            verdicts=verdicts.on_images.get(image.id, ()),
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
    caps = _packed_caps(connection, images, wanted, verdicts, progress=progress)
    with (folder / "instances.json").open("wb") as file:
        count = write_document(file, head, _lines(connection, caps, jobs=jobs))
    if results is not None:
        numbers = {row.name: row.id for row in categories}
        write_results(results, _results(connection, images, wanted, numbers))
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


def _packed_caps(
    connection: Connection, images: list[Image], wanted: Wanted, verdicts: _Verdicts, *, progress: Progress
) -> Iterator[bytes]:
    """Of each image the caps that are written."""
    for done, image in enumerate(images):
        progress(done, len(images), "Writing labels")
        yield _packed_caps_of(connection, image, wanted, verdicts.on_caps.get(image.id, {}))


def _packed_caps_of(
    connection: Connection, image: Image, wanted: Wanted, verdicts: dict[str, list[GivenVerdict]]
) -> bytes:
    run = wanted.run
    if run is not None:
        return packed(image, predictions=stored_predictions(connection, image.id, run_id=run.id))
    if wanted.only == "predicted":
        return packed(image, predictions=stored_predictions(connection, image.id))
    annotations = stored_annotations(connection, image.id)
    if wanted.only == "all" and not annotations and not is_complete(image.status):
        open_ones = stored_open_predictions(connection, image.id)
        return packed(image, predictions=open_ones, before_predictions=BESIDE_ANNOTATIONS)
    kept = annotations if wanted.with_ignored else without_ignored(annotations)
    return packed(image, annotations=kept, verdicts=verdicts)


def _lines(connection: Connection, caps: Iterator[bytes], *, jobs: int) -> Iterator[Lines]:
    """The annotations of each image as they are written, by so many processes where these are worth it."""
    if jobs == 1 or (connection.execute(_CAPS).scalar_one() or 0) < WORTH_PROCESSES:
        return map(lines_of, caps)
    return worked_on(lines_of, caps, jobs=jobs)


_CAPS = select(func.sum(schema.image.c.caps + schema.image.c.predicted))


def _results(
    connection: Connection, images: list[Image], wanted: Wanted, categories: dict[str, int]
) -> Iterator[dict[str, Any]]:
    run = wanted.run
    for image in images:
        if run is None:
            said = load_predictions(connection, image.id)
        else:
            said = predictions_by(connection, run.id, image.id)
        for each in said:
            size = image.width, image.height
            yield result_entry(each, size=size, category=categories[each.category])


def _verdicts(connection: Connection) -> _Verdicts:
    on_images: defaultdict[int, list[GivenVerdict]] = defaultdict(list)
    on_caps: defaultdict[int, defaultdict[str, list[GivenVerdict]]] = defaultdict(lambda: defaultdict(list))
    for each in all_verdicts(connection):
        if each.annotation is None:
            on_images[each.image].append(each)
        else:
            on_caps[each.image][each.annotation].append(each)
    return _Verdicts({**on_images}, {image: {**of_caps} for image, of_caps in on_caps.items()})


def _exported(only: Only, runs: list[tuple[Run, int]]) -> dict[str, Any]:
    """What was exported, for ``info``."""
    listed = [msgspec.to_builtins(run) | {"images": seen} for run, seen in runs]
    return (
        {"exported": only}
        | ({"runs": listed} if runs else {})
        | ({"run": listed[0]} if len(runs) == 1 else {})
    )
