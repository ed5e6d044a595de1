"""Writes what a project holds into a folder that other programs read."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cv2
import msgspec
from msgspec import Struct
from sqlalchemy import Connection, func, select

from fairyring.model.photo import probe, read
from fairyring.model.progress import Progress, silent
from fairyring.storage.choices import Only
from fairyring.storage.contents import load_contents, load_numbered_annotations, load_predictions
from fairyring.storage.db import schema
from fairyring.storage.db.rows import image_of
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.coco_writing import (
    annotation_entry,
    category_entry,
    image_entry,
    prediction_entry,
    write_document,
)
from fairyring.storage.originals import PhotoChangedError
from fairyring.storage.predictions import latest_run
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Image, Prediction, is_complete
from fairyring.storage.whole_folders import made_whole

Cap = Annotation | Prediction
JPEG_QUALITY = 97
BESIDE_ANNOTATIONS = 1 << 31
"""Added to the numbers of predictions that are exported beside annotations, which have lower ones."""


class ExportReport(Struct, frozen=True, kw_only=True):
    """How much an export wrote."""

    images: int
    annotations: int
    """How many annotations, or predictions where those were asked for."""
    partial: int
    """Of how many of the images nobody has said that these are all their caps."""
    left_out: list[str]
    """Sentences about images whose file is not the photo that was imported."""


def export_coco(
    project: Project,
    out: Path,
    *,
    only: Only = Only.annotated,
    with_ignored: bool = False,
    progress: Progress = silent,
) -> ExportReport:
    """Writes ``out/instances.json`` and ``out/images/``; all of it appears at once, or nothing does.

    The state is that of the moment at which the export began. Photos are copied as they are; one that is
    turned by EXIF is written upright, as its coordinates are. An image whose file is no longer the photo that
    was imported is left out, as its labels would go out over another photo.

    Args:
        project: whence.
        out: a new or an empty folder.
        only: which images.
        with_ignored: keeps ignored caps, as ``iscrowd: 1`` and ``ignored: true``.
        progress: called once an image; what it raises ends the export, leaving nothing behind.

    Raises:
        StoreError: ``out`` holds something or cannot be written, a photo is gone, or no image is left.
    """
    with project.read() as connection, made_whole(out) as folder:
        images, left_out = _copy_photos(project, _images(connection, only), folder / "images", progress)
        categories = connection.execute(_CATEGORIES).all()
        licenses: list[dict[str, Any]] = []
        head = {
            "info": _info(connection, project, only),
            "licenses": licenses,
            "categories": [category_entry(row.name, row.extra, number=row.id) for row in categories],
            "images": [
                image_entry(image, partial=_is_partial(image, only), licenses=licenses) for image in images
            ],
        }
        caps = _caps(connection, images, only=only, with_ignored=with_ignored, progress=progress)
        numbers = {row.name: row.id for row in categories}
        with (folder / "instances.json").open("wb") as file:
            count = write_document(file, head, _entries(caps, numbers))
    partial = sum(_is_partial(image, only) for image in images)
    return ExportReport(images=len(images), annotations=count, partial=partial, left_out=left_out)


_CATEGORIES = select(schema.category).order_by(schema.category.c.id)


def _images(connection: Connection, only: Only) -> list[Image]:
    image = schema.image
    wanted = {
        "annotated": (image.c.status != "new") | (image.c.caps + image.c.ignored > 0),
        "approved": image.c.status == "approved",
        "predicted": image.c.run == select(func.max(schema.run.c.id)).scalar_subquery(),
        "all": image.c.id > 0,
    }[only]
    statement = select(image).where(wanted).order_by(image.c.sort_name, image.c.id)
    return [image_of(row) for row in connection.execute(statement)]


def _is_partial(image: Image, only: Only) -> bool:
    """Whether nobody has said that what is written of an image are all its caps."""
    return only == "predicted" or not is_complete(image.status)


def _caps(
    connection: Connection, images: list[Image], *, only: Only, with_ignored: bool, progress: Progress
) -> Iterator[tuple[Image, int, Cap]]:
    """The images, and of each the caps with their numbers in the file."""
    load = _loader(connection, only)
    for done, image in enumerate(images):
        progress(done, len(images), "Writing labels")
        for number, cap in load(image):
            if with_ignored or not (isinstance(cap, Annotation) and cap.cap.ignored):
                yield image, number, cap


def _loader(connection: Connection, only: Only) -> Callable[[Image], list[tuple[int, Any]]]:
    if only == "predicted":
        return lambda image: [(cap.id, cap) for cap in load_predictions(connection, image.id)]
    if only != "all":
        return lambda image: load_numbered_annotations(connection, image.id)

    def load(image: Image) -> list[tuple[int, Any]]:
        annotations = load_numbered_annotations(connection, image.id)
        if annotations or is_complete(image.status):
            return annotations
        said = load_contents(connection, image.id).predictions
        return [(BESIDE_ANNOTATIONS + cap.id, cap) for cap in said]

    return load


def _entries(caps: Iterator[tuple[Image, int, Cap]], categories: dict[str, int]) -> Iterator[dict[str, Any]]:
    for image, number, cap in caps:
        size = image.width, image.height
        if isinstance(cap, Annotation):
            category = categories[cap.cap.category]
            yield annotation_entry(cap, number=number, size=size, category=category)
        else:
            category = categories[cap.category]
            yield prediction_entry(cap, number=number, size=size, category=category)


def _info(connection: Connection, project: Project, only: Only) -> dict[str, Any]:
    info: dict[str, Any] = {"description": project.name, "exported": only}
    run = latest_run(connection) if only in ("predicted", "all") else None
    return info | ({"run": msgspec.to_builtins(run)} if run else {})


def _copy_photos(
    project: Project, images: list[Image], folder: Path, progress: Progress
) -> tuple[list[Image], list[str]]:
    """The images whose photos were copied, and a sentence about each of the others."""
    folder.mkdir()
    copied: list[Image] = []
    left_out: list[str] = []
    for done, image in enumerate(images):
        progress(done, len(images), "Copying photos")
        try:
            target = folder / image.file_name
            target.parent.mkdir(parents=True, exist_ok=True)
            _copy(project.originals.path_of(image), target)
        except PhotoChangedError as error:
            left_out.append(str(error))
        else:
            copied.append(image)
    if left_out and not copied:
        raise StoreError(f"Nothing was exported: {left_out[0]}")
    return copied, left_out


def _copy(source: Path, target: Path) -> None:
    if probe(source).orientation == 1:
        shutil.copyfile(source, target)
        return
    # OpenCV goes by the ending, and does not know all of JPEG's.
    suffix = target.suffix.lower().replace(".jfif", ".jpg") or ".png"
    _, encoded = cv2.imencode(suffix, read(source), [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    target.write_bytes(encoded.tobytes())
