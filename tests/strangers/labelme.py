"""labelme's files, as versions 3 to 7 and tools after its model write them."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tests.strangers.bed import DISCS, HEIGHT, WIDTH, Stranger, circle, mask, photo, png, write

Shape = dict[str, Any]


def polygon(nth: int, **keys: Any) -> Shape:
    return {"label": "mushroom", "points": circle(nth), "shape_type": "polygon"} | keys


def of_version_3(nth: int) -> Shape:
    return {"label": "mushroom", "points": circle(nth), "line_color": None, "fill_color": None}


def circle_of_two(nth: int) -> Shape:
    x, y, r = DISCS[nth]
    return polygon(nth, points=[[x, y], [x + r, y]], shape_type="circle")


def rectangle(nth: int) -> Shape:
    x, y, r = DISCS[nth]
    return polygon(nth, points=[[x + r, y - r], [x - r, y + r]], shape_type="rectangle")


def rotation(nth: int) -> Shape:
    x, y, r = DISCS[nth]
    corners = [[x - r, y - r], [x + r, y - r], [x + r, y + r], [x - r, y + r]]
    return polygon(nth, points=corners, shape_type="rotation", direction=0.0)


def mask_of_box(nth: int) -> Shape:
    x, y, r = (round(value) for value in DISCS[nth])
    cut = mask(nth)[y - r : y + r, x - r : x + r]
    points = [[x - r, y - r], [x + r - 1, y + r - 1]]
    return polygon(nth, points=points, shape_type="mask", mask=png(cut * 255))


def point(nth: int) -> Shape:
    x, y, _ = DISCS[nth]
    return polygon(nth, points=[[x, y]], shape_type="point")


def file(
    shape: Callable[[int], Shape],
    *,
    version: str = "5.5.0",
    path: str = "bed_1.jpg",
    photo_at: str | None = "bed_1.jpg",
    has_data: bool = False,
):
    """A labelme file; its photo lies at ``photo_at``, or in the file alone."""

    def make(folder: Path) -> Sequence[Path]:
        lying = photo(folder / (photo_at or "elsewhere/bed_1.jpg"))
        data = base64.b64encode(lying.read_bytes()).decode() if has_data else None
        if photo_at is None:
            lying.unlink()
        value = {
            "version": version,
            "flags": {},
            "shapes": [shape(nth) for nth in range(2)],
            "imagePath": path,
        }
        value |= {"imageData": data, "imageHeight": HEIGHT, "imageWidth": WIDTH}
        return [write(folder / "labels" / "bed_1.json", value)]

    return make


STRANGERS = [
    Stranger(
        tool="labelme 3",
        what="no shape_type, ..\\bed_1.jpg",
        make=file(of_version_3, version="3.16.7", path="..\\bed_1.jpg", photo_at="labels/bed_1.jpg"),
    ),
    Stranger(
        tool="labelme 4",
        what="polygons, the photo in imageData alone",
        make=file(polygon, version="4.5.6", photo_at=None, has_data=True),
    ),
    Stranger(
        tool="labelme 5",
        what="polygons, ../photos/bed_1.jpg",
        make=file(polygon, path="../photos/bed_1.jpg", photo_at="photos/bed_1.jpg"),
    ),
    Stranger(
        tool="labelme 5",
        what="circles",
        make=file(circle_of_two, photo_at="labels/bed_1.jpg"),
        shape="circle",
    ),
    Stranger(
        tool="labelme 5",
        what="rectangles",
        make=file(rectangle, photo_at="labels/bed_1.jpg"),
        shape="box",
        said="2 boxes",
    ),
    Stranger(
        tool="labelme 6",
        what="masks (AI-Mask)",
        make=file(mask_of_box, version="6.0.0", photo_at="labels/bed_1.jpg"),
    ),
    Stranger(
        tool="labelme 7",
        what="polygons with keys of its own",
        make=file(
            lambda nth: polygon(nth, description="", mask=None, flags={}, other_data={"a": 1}),
            version="7.0.0",
            photo_at="labels/bed_1.jpg",
        ),
    ),
    Stranger(
        tool="labelme 5",
        what="points alone",
        make=file(point, photo_at="labels/bed_1.jpg"),
        caps=0,
        exit_code=1,
        said="Shapes of type 'point' are not known here",
    ),
    Stranger(
        tool="X-AnyLabeling",
        what="rotated boxes",
        make=file(rotation, version="2.4.0", photo_at="labels/bed_1.jpg"),
        shape="box",
        said="2 boxes",
    ),
]
