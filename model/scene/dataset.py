"""Writes a set of beds, photos and one COCO file, in several processes; it can be stopped and continued.

While it runs, every finished bed has a part of its own under ``OUT/.parts``; the last act joins them.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path
from typing import Any

import cv2
import msgspec

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.coco.writing import DECIMALS, occlusion_keys, outline_keys, rounded, shape_keys
from fairyring.model.processes import worked_on
from fairyring.model.progress import Progress, silent
from fairyring.model.scene.bed import Bed, render_bed
from fairyring.model.scene.settings import SceneError, Settings
from fairyring.model.scene.truth import BedCap

PARTS = ".parts"
DOCUMENT = "instances.json"


def write_beds(
    out: Path,
    settings: Settings,
    *,
    count: int,
    seed: int,
    jobs: int = 1,
    resume: bool = False,
    progress: Progress = silent,
) -> int:
    """Writes ``out/instances.json`` and ``out/images/``; returns how many beds were rendered just now.

    The files do not depend on ``jobs`` or on whether the work was interrupted. With ``resume`` the beds that
    ``out`` holds already are kept, and there may be fewer of them than ``count``. Raises SceneError where
    ``out`` holds anything else.
    """
    out = Path(out)
    head = _head(settings, seed)
    _open_folder(out, head, resume=resume)
    missing = [index for index in range(count) if not _is_done(out, index)]
    done = count - len(missing)
    progress(done, count, "rendering")
    for _ in worked_on(_render_one, [(out, settings, seed, index) for index in missing], jobs=jobs):
        done += 1
        progress(done, count, "rendering")
    _join(out, head, count)
    return len(missing)


def annotation_of_cap(cap: BedCap) -> dict[str, Any]:
    """A cap in the contracts' keys, but for its id and its image's."""
    return {
        "category_id": 1,
        **outline_keys(cap.visible),
        "iscrowd": 0,
        "center": rounded(cap.centre),
        **shape_keys(cap.ellipse),
        "amodal_segmentation": [cap.whole],
        "visible_fraction": round(cap.visible_fraction, DECIMALS),
        **occlusion_keys(cap.visible_fraction),
        "order": cap.order,
    }


def name_of_bed(index: int) -> str:
    """The base file name of a bed's photo."""
    return f"bed_{index:05d}.jpg"


def _head(settings: Settings, seed: int) -> dict[str, Any]:
    return {
        "description": "Rendered mushroom beds; whole outlines are known where caps are hidden.",
        "seed": seed,
        "settings": msgspec.to_builtins(settings),
    }


def _open_folder(out: Path, head: dict[str, Any], *, resume: bool) -> None:
    key = hashlib.sha256(msgspec.json.encode(head)).hexdigest()
    marker = out / PARTS / "settings"
    if out.exists() and not out.is_dir():
        raise SceneError(f"{out} is a file; give a new or empty folder.")
    if any(path.is_file() for path in out.rglob("*")):
        if not resume:
            raise SceneError(f"{out} is not empty; give a new folder, or --resume to continue in it.")
        if (out / DOCUMENT).exists():
            _take_apart(out, head)
        elif not marker.exists() or marker.read_text() != key:
            raise SceneError(f"{out} was not begun with this seed and these settings; give a new folder.")
    marker.parent.mkdir(parents=True, exist_ok=True)
    _write(marker, key.encode())
    (out / "images").mkdir(exist_ok=True)


def _take_apart(out: Path, head: dict[str, Any]) -> None:
    """Makes parts of a finished set again, so that more beds can be added to it."""
    try:
        document = msgspec.json.decode((out / DOCUMENT).read_bytes())
        if document["info"] != msgspec.json.decode(msgspec.json.encode(head)):
            raise SceneError(f"{out} was made with another seed or other settings; give a new folder.")
        (out / PARTS).mkdir(exist_ok=True)
        own: dict[int, list[dict[str, Any]]] = {image["id"]: [] for image in document["images"]}
        for annotation in document["annotations"]:
            own[annotation.pop("image_id")].append(annotation)
        for image in document["images"]:
            number = image.pop("id")
            _write(_part(out, number - 1), msgspec.json.encode({"image": image, "annotations": own[number]}))
    except (msgspec.DecodeError, KeyError, TypeError) as error:
        raise SceneError(f"{out / DOCUMENT} is no set of rendered beds; give a new folder.") from error


def _part(out: Path, index: int) -> Path:
    return out / PARTS / f"{index:05d}.json"


def _is_done(out: Path, index: int) -> bool:
    return _part(out, index).exists() and (out / "images" / name_of_bed(index)).exists()


def _render_one(task: tuple[Path, Settings, int, int]) -> None:
    out, settings, seed, index = task
    bed = render_bed(settings, seed=seed, index=index)
    _write(out / "images" / name_of_bed(index), encoded(bed))
    rows, columns, _ = bed.image.shape
    image = {"file_name": name_of_bed(index), "width": columns, "height": rows, "light": bed.light}
    part = {
        "image": image | ({"form": bed.form} if bed.form else {}),
        "annotations": [annotation_of_cap(cap) for cap in bed.caps],
    }
    _write(_part(out, index), msgspec.json.encode(part))


def encoded(bed: Bed) -> bytes:
    """The photo as the bytes of a JPEG file."""
    return cv2.imencode(".jpg", bed.image, [cv2.IMWRITE_JPEG_QUALITY, bed.jpeg])[1].tobytes()


def _write(file: Path, content: bytes) -> None:
    """All of it or nothing."""
    fresh = file.with_name(f"{file.name}.{os.getpid()}")
    fresh.write_bytes(content)
    fresh.replace(file)


def _join(out: Path, head: dict[str, Any], count: int) -> None:
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    for number in range(1, count + 1):
        part = msgspec.json.decode(_part(out, number - 1).read_bytes())
        images.append({"id": number} | part["image"])
        for annotation in part["annotations"]:
            annotation.pop("id", None)
            annotations.append({"id": len(annotations) + 1, "image_id": number} | annotation)
    document = {
        "info": head,
        "images": images,
        "categories": [{"id": 1, "name": DEFAULT_CATEGORY, "supercategory": "fungus"}],
        "annotations": annotations,
    }
    _write(out / DOCUMENT, msgspec.json.encode(document))
    shutil.rmtree(out / PARTS)
