"""Draws the caps of checked photos whose centres a contour method gets most wrong.

Visible mask tinted; its arcs green (own rim), red (behind a neighbour), orange (image border), blue (hollow);
the outline found magenta, with the ellipse of two standard deviations around its centre; the truth cyan.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.coco import silhouettes_of
from fairyring.model.contour.reconstruct import reconstruct_silhouettes
from fairyring.model.contour.result import ArcKind, Reconstruction
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.errors import FileError
from fairyring.model.evaluate.centres import centre_error
from fairyring.model.geometry.shapes import Circle, Ellipse, Points, points_of_part, polygon_of_shape
from fairyring.model.json_files import read_json
from fairyring.model.photo import read

COUNT, COLUMNS = 10, 5
PANEL, CAPTION, LINE = 400, 112, 20
"""Side of the picture of a cap, height of the caption below it, height of one line of that; pixels."""
FIT, TRUTH, MASK = (255, 0, 255), (255, 255, 0), (90, 200, 90)
KINDS: dict[ArcKind, tuple[int, int, int]] = {
    "visible": (0, 220, 0),
    "hidden": (0, 0, 255),
    "border": (0, 160, 255),
    "concave": (255, 120, 0),
}

Picture = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class Miss:
    """A cap of a photo, its annotation, and what a method made of it."""

    photo: Path
    annotation: dict[str, Any]
    cap: Silhouette
    found: Reconstruction
    cdr: float
    """CDR, percent (Eq. 10)."""
    px: float


def draw_worst(checked: Path, out: Path, *, methods: Sequence[str]) -> None:
    """Draws the ``COUNT`` worst of the certain caps by each method into the folder ``out``.

    ``checked`` is a COCO file as `measured_by_coverage` takes it, or the folder of one called checked.json;
    its photos lie beside it, or in images/ there. Writes METHOD-worst.png with all of them and, of each,
    METHOD-RANK-PHOTO-ID.png. Raises FairyringError for what cannot be read or written.
    """
    labels = checked / "checked.json" if checked.is_dir() else checked
    document = read_json(labels)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{out} cannot be made: {error.strerror}; give --pictures another folder.") from error
    for method in methods:
        misses = [miss for image in document["images"] for miss in _misses(document, image, labels, method)]
        worst = sorted(misses, key=lambda miss: miss.cdr, reverse=True)[:COUNT]
        panels = [_panel(miss, f"{method} {rank}") for rank, miss in enumerate(worst, 1)]
        for rank, (miss, panel) in enumerate(zip(worst, panels, strict=True), 1):
            _write(panel, out / f"{method}-{rank:02}-{miss.photo.stem}-{miss.annotation['id']}.png")
        _write(_sheet(panels), out / f"{method}-worst.png")


def _misses(document: dict[str, Any], image: dict[str, Any], labels: Path, method: str) -> list[Miss]:
    width, height = image["width"], image["height"]
    annotations = [each for each in document["annotations"] if each["image_id"] == image["id"]]
    caps = silhouettes_of(annotations, width=width, height=height)
    found = reconstruct_silhouettes(caps, width=width, height=height, method=method)
    photo = labels.parent / "images" / image["file_name"]
    misses = []
    for annotation, cap, each in zip(annotations, caps, found, strict=True):
        if annotation.get("ignore") or annotation.get("doubt") or each.fit.centre is None:
            continue
        off = centre_error(each.fit.centre, annotation["center"], width=width, height=height, diameter=None)
        misses.append(
            Miss(
                photo=photo if photo.exists() else labels.parent / image["file_name"],
                annotation=annotation,
                cap=cap,
                found=each,
                cdr=off.cdr,
                px=off.px,
            )
        )
    return misses


def _panel(miss: Miss, title: str) -> Picture:
    """A picture of one cap, twice as wide as its whole outline, with a caption."""
    photo = read(miss.photo)
    truth = _truth(miss.annotation)
    size = 2 * max(truth.r if isinstance(truth, Circle) else truth.a, 12)
    frame = _Frame(scale=PANEL / (2 * size), left=truth.cx - size, top=truth.cy - size)
    picture = frame.cut(_tinted(photo, miss.cap))
    for arc in miss.found.arcs:
        frame.line(picture, arc.points, KINDS[arc.kind], thick=2)
    for shape, colour in ((truth, TRUTH), (miss.found.fit.whole, FIT)):
        if shape is not None:
            frame.line(picture, points_of_part(polygon_of_shape(shape)), colour, closed=True)
            frame.cross(picture, (shape.cx, shape.cy), colour)
    if miss.found.fit.centre is not None and miss.found.fit.centre_sd is not None:
        (cx, cy), (sx, sy) = miss.found.fit.centre, miss.found.fit.centre_sd
        doubt = Ellipse(cx=cx, cy=cy, a=max(2 * sx, 0.2), b=max(2 * sy, 0.2), theta_deg=0)
        frame.line(picture, points_of_part(polygon_of_shape(doubt)), FIT, closed=True)
    return np.vstack([picture, _words(miss, title)])


def _truth(annotation: dict[str, Any]) -> Circle | Ellipse:
    if annotation.get("ellipse"):
        cx, cy, a, b, theta = annotation["ellipse"]
        return Ellipse(cx=cx, cy=cy, a=a, b=b, theta_deg=theta)
    cx, cy = annotation["center"]
    return Circle(cx=cx, cy=cy, r=annotation["circle"][2] if annotation.get("circle") else 20.0)


def _tinted(photo: Picture, cap: Silhouette) -> Picture:
    tinted = photo.copy()
    rows, columns = cap.mask.shape
    part = tinted[cap.top : cap.top + rows, cap.left : cap.left + columns]
    part[cap.mask > 0] = (0.75 * part[cap.mask > 0] + 0.25 * np.array(MASK)).astype(np.uint8)
    return tinted


@dataclass(frozen=True, slots=True)
class _Frame:
    """The part of a photo that a picture shows, and its enlargement."""

    scale: float
    left: float
    top: float

    def cut(self, photo: Picture) -> Picture:
        # OpenCV counts pixel indices, half a pixel less than our coordinates, on either side.
        x, y = ((0.5 - low) * self.scale - 0.5 for low in (self.left, self.top))
        matrix = np.array([[self.scale, 0, x], [0, self.scale, y]])
        return cv2.warpAffine(photo, matrix, (PANEL, PANEL), flags=cv2.INTER_CUBIC).astype(np.uint8)

    def line(
        self,
        picture: Picture,
        points: Points,
        colour: tuple[int, int, int],
        *,
        thick: int = 1,
        closed: bool = False,
    ) -> None:
        at = (points - (self.left, self.top)) * self.scale - 0.5
        cv2.polylines(picture, [np.round(at * 16).astype(np.int32)], closed, colour, thick, cv2.LINE_AA, 4)

    def cross(self, picture: Picture, at: tuple[float, float], colour: tuple[int, int, int]) -> None:
        (x, y), arm = at, 4 / self.scale
        self.line(picture, np.array([[x - arm, y], [x + arm, y]]), colour, thick=2)
        self.line(picture, np.array([[x, y - arm], [x, y + arm]]), colour, thick=2)


def _words(miss: Miss, title: str) -> Picture:
    visible = miss.annotation.get("visible_fraction")
    known = "" if visible is None else f", {100 * visible:.0f} % in sight"
    sd = miss.found.fit.centre_sd
    doubt = "" if sd is None else f", sd {sd[0]:.1f} {sd[1]:.1f} px"
    head = f"{title}: CDR {miss.cdr:.2f} %, {miss.px:.1f} px{known}{doubt}"
    # OpenCV's letters are ASCII alone.
    why = miss.found.why.replace("°", " deg").encode("ascii", "replace").decode()
    picture = np.zeros((CAPTION, PANEL, 3), np.uint8)
    for row, text in enumerate([*textwrap.wrap(head, 50), *textwrap.wrap(why, 50)][: CAPTION // LINE]):
        cv2.putText(
            picture, text, (6, LINE * (row + 1) - 4), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (255, 255, 255), 1
        )
    return picture


def _sheet(panels: Sequence[Picture]) -> Picture:
    blank = np.zeros((PANEL + CAPTION, PANEL, 3), np.uint8)
    cells = [*panels, *([blank] * (-len(panels) % COLUMNS))] or [blank] * COLUMNS
    rows = [np.hstack(cells[at : at + COLUMNS]) for at in range(0, len(cells), COLUMNS)]
    return np.vstack(rows).astype(np.uint8)


def _write(picture: Picture, path: Path) -> None:
    try:
        path.write_bytes(cv2.imencode(".png", picture)[1].tobytes())
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror}.") from error
