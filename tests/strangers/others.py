"""Files of kinds that are not read: they are named, and their photos taken."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from tests.strangers.bed import DISCS, HEIGHT, WIDTH, Stranger, circle, flat, mask, photo, write


def beside_photo(place: str, value: Any) -> Callable[[Path], Sequence[Path]]:
    """A folder with a photo and a file."""

    def make(folder: Path) -> Sequence[Path]:
        photo(folder / "images" / "bed_1.jpg")
        write(folder / place, value)
        return [folder]

    return make


def yolo(folder: Path) -> Sequence[Path]:
    photo(folder / "images" / "bed_1.jpg")
    outlines = [flat(circle(nth, scale=(1 / WIDTH, 1 / HEIGHT))) for nth in range(2)]
    lines = [" ".join(map(str, [0, *numbers])) for numbers in outlines]
    write(folder / "labels" / "bed_1.txt", "\n".join(lines) + "\n")
    write(folder / "data.yaml", "train: images\nnames:\n  0: mushroom\n")
    return [folder]


def cellpose(name: str) -> Callable[[Path], Sequence[Path]]:
    def make(folder: Path) -> Sequence[Path]:
        photo(folder / "bed_1.jpg")
        numbered = (mask(0) + 2 * mask(1)).astype(np.uint16)
        (folder / name).parent.mkdir(exist_ok=True)
        assert cv2.imwrite(str(folder / name), numbered)
        return [folder]

    return make


def in_seg_npy(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    np.save(folder / "bed_1_seg.npy", mask(0))
    return [folder]


def phone(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    write(folder / "bed_2.heic", "ftypheic")
    write(folder / "bed_3.gif", "GIF89a")
    return [folder]


def regions() -> list[dict[str, Any]]:
    points = [circle(nth) for nth in range(2)]
    return [
        {
            "shape_attributes": {
                "name": "polygon",
                "all_points_x": [x for x, _ in each],
                "all_points_y": [y for _, y in each],
            },
            "region_attributes": {"name": "mushroom"},
        }
        for each in points
    ]


VIA = {"bed_1.jpg1234": {"filename": "bed_1.jpg", "size": 1234, "regions": regions(), "file_attributes": {}}}
STUDIO = [{"id": 1, "data": {"image": "/data/upload/bed_1.jpg"}, "annotations": [{"result": []}]}]
VOC = "<annotation><filename>bed_1.jpg</filename><object><name>mushroom</name></object></annotation>"
CVAT = '<?xml version="1.0"?><annotations><version>1.1</version><image name="bed_1.jpg"/></annotations>'
CREATE_ML = [
    {"image": "bed_1.jpg", "annotations": [{"label": "mushroom", "coordinates": {"x": DISCS[0][0]}}]}
]


def unread(
    tool: str, what: str, make: Callable[[Path], Sequence[Path]], said: str, exit_code: int = 1
) -> Stranger:
    return Stranger(tool=tool, what=what, make=make, caps=0, said=said, exit_code=exit_code)


STRANGERS = [
    unread("ultralytics", "YOLO: images/, labels/*.txt, data.yaml", yolo, "it is labels of YOLO"),
    unread("VIA", "a project in JSON", beside_photo("via.json", VIA), "This is labels of VIA"),
    unread(
        "Label Studio", "its own JSON", beside_photo("export.json", STUDIO), "This is labels of Label Studio"
    ),
    unread(
        "VOC", "Annotations/*.xml", beside_photo("Annotations/bed_1.xml", VOC), "it is labels of Pascal VOC"
    ),
    unread("CVAT", "CVAT for images, XML", beside_photo("annotations.xml", CVAT), "it is labels of CVAT"),
    unread("CreateML", "JSON", beside_photo("labels.json", CREATE_ML), "This is labels of CreateML"),
    unread("cellpose", "bed_1_cp_masks.png", cellpose("bed_1_cp_masks.png"), "it is a picture of masks"),
    unread("cellpose", "bed_1_seg.npy", in_seg_npy, "it is masks of cellpose"),
    unread("any", "masks/bed_1.png", cellpose("masks/bed_1.png"), "it is a picture of masks"),
    unread("phone", "photos in HEIC and GIF among others", phone, "it is a photo in HEIC", exit_code=0),
]
