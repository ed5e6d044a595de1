"""Draws the pictures of docs/contours.md on a rendered bed: ``python docs/draw_contours.py``."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from fairyring.model.contour.classify import Limits, defects_of
from fairyring.model.contour.paper import reconstruct_contour
from fairyring.model.contour.reconstruct import reconstruct_silhouettes
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, contours_of, silhouette_of_outline
from fairyring.model.geometry.shapes import Circle, Ellipse, Points, points_of_part, polygon_of_shape
from fairyring.model.scene.bed import Bed, render_bed
from fairyring.model.scene.presets import preset

PICTURES = Path(__file__).parent / "pictures"
Picture = np.ndarray
Colour = tuple[int, int, int]

TRUTH, FIT, CORNER = (255, 255, 0), (255, 0, 255), (0, 0, 255)
KINDS: dict[str, Colour] = {
    "visible": (0, 220, 0),
    "hidden": (0, 0, 255),
    "border": (0, 160, 255),
    "concave": (255, 120, 0),
}
PIECES: tuple[Colour, ...] = ((0, 220, 0), (0, 160, 255), (255, 120, 0), (200, 0, 200), (0, 220, 220))
BED = 3
ZOOM, PANEL = 5, 400
FAILURES = 8


def main() -> None:
    """Writes the steps of section 5, a whole bed by `map`, and what fails."""
    PICTURES.mkdir(exist_ok=True)
    bed = render_bed(preset("default"), seed=3, index=BED)
    height, width = bed.image.shape[:2]
    caps = [silhouette_of_outline(cap.visible, width=width, height=height) for cap in bed.caps]
    found = reconstruct_silhouettes(caps, width=width, height=height)
    _write("contour-steps", _steps(bed, caps))
    _write("contour-bed", _whole_bed(bed, found))
    _write("contour-failures", _failures(bed, found))


def _steps(bed: Bed, caps: list[Silhouette]) -> Picture:
    """Section 5 on two irregular caps: contour, corners, sub-contours, fit beside the truth."""
    partly = [
        i for i in _inside(bed) if 0.5 < bed.caps[i].visible_fraction < 0.88 and bed.caps[i].diameter > 40
    ]
    return np.vstack([_row_of_steps(bed, caps[index], index) for index in partly[:2]])


def _row_of_steps(bed: Bed, cap: Silhouette, index: int) -> Picture:
    contour, area = contours_of(cap)[0], float(cap.mask.sum())
    steps = reconstruct_contour(contour, area=area)
    centre = contour.mean(axis=0)
    panels = [_panel(bed.image, centre) for _ in range(4)]
    _line(panels[0], contour, centre, KINDS["visible"], closed=True)
    _line(panels[1], contour, centre, KINDS["visible"], closed=True)
    for defect in defects_of(contour):
        if not Limits().ignore(defect, length=len(contour), area=area):
            _line(panels[1], contour[[defect.start, defect.end]], centre, FIT)
    for corner in steps.corners:
        _dot(panels[1], contour[corner], centre, CORNER)
    for piece, colour in zip(steps.pieces, PIECES * len(steps.pieces), strict=False):
        _line(panels[2], piece, centre, colour, thick=2 + 2 * (piece is steps.chosen))
    _line(panels[3], steps.chosen, centre, KINDS["visible"], thick=4)
    _shape(panels[3], steps.whole, centre, FIT)
    _shape(panels[3], bed.caps[index].ellipse, centre, TRUTH)
    return np.hstack(panels)


def _whole_bed(bed: Bed, found: list[Reconstruction]) -> Picture:
    """Arcs by kind, the most probable outlines, and centres with ellipses of two standard deviations."""
    scale = 1.5
    picture = cv2.resize(bed.image, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    for each in found:
        fit = each.fit
        if fit.whole is None or fit.centre is None or fit.centre_sd is None:
            continue
        _polyline(picture, points_of_part(polygon_of_shape(fit.whole)) * scale, FIT, closed=True)
        for arc in each.arcs:
            _polyline(picture, arc.points * scale, KINDS[arc.kind], thick=2)
        axes = tuple(max(2, round(2 * scale * sd)) for sd in fit.centre_sd)
        centre = tuple(round(scale * value) for value in fit.centre)
        cv2.ellipse(picture, centre, axes, 0, 0, 360, TRUTH, 1, cv2.LINE_AA)
    return picture


def _failures(bed: Bed, found: list[Reconstruction]) -> Picture:
    """The caps inside the image whose centres are furthest off, in diameters."""

    def off(index: int) -> float:
        centre = found[index].fit.centre or (0.0, 0.0)
        return float(np.hypot(*np.subtract(centre, bed.caps[index].centre))) / bed.caps[index].diameter

    worst = sorted(_inside(bed), key=off, reverse=True)[:FAILURES]
    panels = []
    for index in worst:
        centre = np.array(bed.caps[index].centre)
        panel = _panel(bed.image, centre)
        for arc in found[index].arcs:
            _line(panel, arc.points, centre, KINDS[arc.kind], thick=2)
        _shape(panel, found[index].fit.whole, centre, FIT)
        _shape(panel, bed.caps[index].ellipse, centre, TRUTH)
        panels.append(panel)
    half = FAILURES // 2
    return np.vstack([np.hstack(panels[:half]), np.hstack(panels[half:])])


def _inside(bed: Bed) -> list[int]:
    """The caps that the image's border does not cut."""
    size = bed.image.shape[1::-1]
    wholes = [points_of_part(cap.whole) for cap in bed.caps]
    return [i for i, whole in enumerate(wholes) if (whole > 0).all() and (whole < size).all()]


def _panel(image: Picture, centre: Points) -> Picture:
    """A square around ``centre``, enlarged."""
    side = PANEL // ZOOM
    padded = cv2.copyMakeBorder(image, side, side, side, side, cv2.BORDER_CONSTANT)
    x, y = np.floor(centre).astype(int) + side - side // 2
    crop = padded[max(0, y) : max(0, y) + side, max(0, x) : max(0, x) + side]
    return cv2.resize(crop, (PANEL, PANEL), interpolation=cv2.INTER_CUBIC)


def _in_panel(points: Points, centre: Points) -> Points:
    side = PANEL // ZOOM
    return (points - (np.floor(centre) - side // 2)) * ZOOM


def _line(
    panel: Picture, points: Points, centre: Points, colour: Colour, *, thick: int = 2, closed: bool = False
) -> None:
    _polyline(panel, _in_panel(points, centre), colour, thick=thick, closed=closed)


def _shape(panel: Picture, shape: Circle | Ellipse | None, centre: Points, colour: Colour) -> None:
    if shape is not None:
        _line(panel, points_of_part(polygon_of_shape(shape)), centre, colour, closed=True)
        _dot(panel, np.array([shape.cx, shape.cy]), centre, colour)


def _dot(panel: Picture, point: Points, centre: Points, colour: Colour) -> None:
    x, y = np.round(_in_panel(point, centre)).astype(int).tolist()
    cv2.circle(panel, (x, y), 6, colour, -1, cv2.LINE_AA)


def _polyline(
    picture: Picture, points: Points, colour: Colour, *, thick: int = 1, closed: bool = False
) -> None:
    # OpenCV counts pixel indices; with shift 4, in sixteenths.
    indices = np.round((points - 0.5) * 16).astype(np.int32)
    cv2.polylines(picture, [indices], closed, colour, thick, cv2.LINE_AA, 4)


def _write(name: str, picture: Picture) -> None:
    cv2.imwrite(str(PICTURES / f"{name}.jpg"), picture, [cv2.IMWRITE_JPEG_QUALITY, 82])


if __name__ == "__main__":
    main()
