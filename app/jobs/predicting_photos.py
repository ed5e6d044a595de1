"""Predicts photos that belong to no project, as a COCO document."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from fairyring.app.jobs.finders import Finder
from fairyring.app.jobs.predicting import predictions_in
from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.errors import FairyringError
from fairyring.model.photo import SUFFIXES, probe
from fairyring.model.progress import Progress, silent
from fairyring.storage.formats.coco_geometry import geometry_keys
from fairyring.storage.formats.coco_writing import category_entry, drawn, prediction_entry
from fairyring.storage.records import Image, Prediction


def photos_at(paths: Sequence[Path]) -> list[Path]:
    """The photos that were named, and those in folders among them. Raises FairyringError without any."""
    photos = [photo for path in paths for photo in _photos_of(path)]
    if not photos:
        named = ", ".join(map(str, paths))
        raise FairyringError(f"There is no photo in {named}; name photos or folders of them.")
    return photos


def predict_photos(
    photos: Sequence[Path], finder: Finder, *, progress: Progress = silent
) -> tuple[dict[str, Any], list[str]]:
    """The document of what is seen in photos, and a sentence for each that could not be read."""
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    problems: list[str] = []
    for done, path in enumerate(photos):
        progress(done, len(photos), f"Predicting {path.name}")
        try:
            image = _image(path, number=len(images) + 1)
            entries = list(_entries(finder, path, image, first=len(annotations) + 1))
        except FairyringError as error:
            problems.append(str(error))
            continue
        images.append({"id": image.id, "file_name": str(path), "width": image.width, "height": image.height})
        annotations += entries
    info = {"description": "Predicted by Fairyring", "weights": finder.digest, "settings": finder.settings}
    categories = [category_entry(DEFAULT_CATEGORY, {}, number=1)]
    return {"info": info, "categories": categories, "images": images, "annotations": annotations}, problems


def _image(path: Path, *, number: int) -> Image:
    info = probe(path)
    return Image(
        id=number,
        file_name=path.name,
        path=str(path),
        width=info.width,
        height=info.height,
        sha256=info.sha256,
    )


def _entries(finder: Finder, path: Path, image: Image, *, first: int) -> Iterator[dict[str, Any]]:
    found, _ = predictions_in(finder, path, image)
    said = [
        Prediction(
            id=number,
            run=0,
            image=image.id,
            visible=new.visible,
            score=new.score,
            quality=new.quality,
            whole=new.fit.whole,
            centre=new.fit.centre,
            extra=new.extra,
        )
        for number, new in enumerate(found, start=first)
    ]
    geometry = geometry_keys([drawn(each) for each in said], size=(image.width, image.height))
    for each, keys in zip(said, geometry, strict=True):
        yield prediction_entry(each, keys, number=each.id, category=1)


def _photos_of(path: Path) -> list[Path]:
    if not path.exists():
        raise FairyringError(f"{path} does not exist; check the path.")
    if path.is_dir():
        return sorted(file for file in path.rglob("*") if file.suffix.lower() in SUFFIXES and file.is_file())
    return [path]
