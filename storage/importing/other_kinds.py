"""Files that an import knows by sight and does not read: what they are, and what to do about them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from msgspec import Struct

from fairyring.model.json_files import JsonError, parse_json
from fairyring.model.photo import SUFFIXES

AS_COCO = "export COCO from there, or convert it"
BYTES_SEEN = 4096
"""Of a file that is no JSON."""


class OtherKind(Struct, frozen=True):
    """A kind of file that is not read."""

    name: str
    remedy: str
    has_labels: bool = True

    def __str__(self) -> str:
        return f"{self.name}, which is not read; {self.remedy}"


HEIC = OtherKind("a photo in HEIC", "save it as JPEG", has_labels=False)
AVIF = OtherKind("a photo in AVIF", "save it as JPEG", has_labels=False)
GIF = OtherKind("a picture in GIF", "save it as PNG", has_labels=False)
RAW = OtherKind("a raw photo", "develop it and save it as JPEG or TIFF", has_labels=False)
ARCHIVE = OtherKind("an archive", "unpack it and import the folder", has_labels=False)
YOLO = OtherKind("labels of YOLO", AS_COCO)
CLASSES = OtherKind("a list of YOLO's classes", AS_COCO, has_labels=False)
VOC = OtherKind("labels of Pascal VOC", AS_COCO)
CVAT = OtherKind("labels of CVAT in XML", "export COCO 1.0 from there")
CELLPOSE = OtherKind("masks of cellpose", "save them as outlines, or as COCO")
VIA = OtherKind("labels of VIA", "export COCO format from there")
LABEL_STUDIO = OtherKind("labels of Label Studio", "export COCO from there")
CREATE_ML = OtherKind("labels of CreateML", AS_COCO)
LABELBOX = OtherKind("labels of Labelbox", AS_COCO)
SUPERVISELY = OtherKind("labels of Supervisely", AS_COCO)
DATUMARO = OtherKind("labels of datumaro's own format", AS_COCO)
GEOJSON = OtherKind("labels in GeoJSON", AS_COCO)
MASKS = OtherKind("a picture of masks beside its photo", "give the masks as COCO, for example as RLE")

BY_SUFFIX = {
    **dict.fromkeys((".heic", ".heif"), HEIC),
    **dict.fromkeys((".dng", ".cr2", ".cr3", ".nef", ".arw", ".orf", ".rw2", ".raf"), RAW),
    **dict.fromkeys((".zip", ".tar", ".gz", ".tgz", ".7z", ".rar", ".bz2", ".xz"), ARCHIVE),
    ".avif": AVIF,
    ".gif": GIF,
}
LINE_OF_YOLO = re.compile(rb"\s*\d+(\s+-?[0-9.]+(e-?\d+)?){4,}\s*")
MASK = re.compile(
    r"(?i)(.+?)[_.-](cp_masks?|masks?|seg|segmentation|labels?|labelids|instances?|instanceids|gt)"
)
MASK_FOLDERS = {"masks", "mask", "segmentations", "segmentationobject", "segmentationclass"}
PHOTO_FOLDERS = ("images", "imgs", "photos", "JPEGImages", "img")


def other_kind_of(file: Path) -> OtherKind | None:
    """The kind of a file that is neither a photo nor JSON by its name; None where it is not known."""
    suffix = file.suffix.lower()
    if suffix in BY_SUFFIX:
        return BY_SUFFIX[suffix]
    if file.name.lower().endswith("_seg.npy"):
        return CELLPOSE
    if suffix not in (".txt", ".xml", ".yaml", ".yml", ".csv"):
        return None
    with file.open("rb") as opened:
        head = opened.read(BYTES_SEEN)
    return _kind_of_text(suffix, head)


def _kind_of_text(suffix: str, head: bytes) -> OtherKind | None:
    if suffix == ".txt":
        # The last line may be cut off.
        lines = [line for line in head.splitlines()[:20] if line.strip()]
        return YOLO if lines and LINE_OF_YOLO.fullmatch(lines[0]) else None
    if suffix == ".xml":
        kinds = ((b"<annotations>", CVAT), (b"<annotation", VOC))
    elif suffix == ".csv":
        kinds = ((b"region_shape_attributes", VIA),)
    else:
        kinds = ((b"names:", CLASSES),)
    return next((kind for word, kind in kinds if word in head), None)


def other_kind_of_json(data: bytes) -> OtherKind | None:
    """The kind of a JSON file that is neither COCO's nor labelme's; None where it is not known."""
    try:
        value = parse_json(data)
    except JsonError:
        return None
    return next((kind for kind, has in _KINDS_OF_JSON if has(value)), None)


def _first_of(value: Any) -> dict[str, Any]:
    first = value[0] if isinstance(value, list) and value else None
    return first if isinstance(first, dict) else {}


def _is_of_via(value: Any) -> bool:
    if not isinstance(value, dict):
        return False
    entries: Iterable[Any] = value.values()
    return any(key.startswith("_via_") for key in value) or any(
        isinstance(entry, dict) and {"filename", "regions"} <= entry.keys() for entry in entries
    )


def _keys_of(value: Any) -> set[str]:
    return set(value) if isinstance(value, dict) else set()


_KINDS_OF_JSON: tuple[tuple[OtherKind, Callable[[Any], bool]], ...] = (
    (VIA, _is_of_via),
    (
        LABEL_STUDIO,
        lambda value: (
            "data" in _first_of(value) and bool({"annotations", "completions"} & _first_of(value).keys())
        ),
    ),
    (CREATE_ML, lambda value: {"image", "annotations"} <= _first_of(value).keys()),
    (
        LABELBOX,
        lambda value: bool({"data_row", "Labeled Data"} & (_first_of(value).keys() | _keys_of(value))),
    ),
    (SUPERVISELY, lambda value: {"objects", "size"} <= _keys_of(value)),
    (DATUMARO, lambda value: {"items", "categories"} <= _keys_of(value)),
    (GEOJSON, lambda value: _keys_of(value) >= {"type", "features"}),
)


def is_picture_of_masks(file: Path) -> bool:
    """Whether a picture is named after a photo that lies beside it, or in the folder for photos."""
    named = MASK.fullmatch(file.stem)
    folders = [file.parent]
    if file.parent.name.lower() in MASK_FOLDERS and file.suffix.lower() not in (".jpg", ".jpeg"):
        above = file.parent.parent
        folders = [above, *(above / name for name in PHOTO_FOLDERS)]
    elif named is None:
        return False
    stems = {file.stem, named[1]} if named else {file.stem}
    return any(_has_photo(folder, stem, file) for folder in folders for stem in stems)


def _has_photo(folder: Path, stem: str, besides: Path) -> bool:
    photos = (folder / f"{stem}{suffix}" for suffix in (*SUFFIXES, *map(str.upper, SUFFIXES)))
    return any(photo != besides and photo.is_file() for photo in photos)
