"""Close-ups of caps: the photo, what people drew, what was predicted, and the line between the centres."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.app.caps.records import prediction_record, truth_record
from fairyring.app.review.figures import ReviewedCap
from fairyring.app.review.reviewed import predictions_of
from fairyring.model.evaluate.centres import compare
from fairyring.model.geometry.boxes import boxes_of_outlines
from fairyring.model.geometry.shapes import Centre, Outline, points_of_part, polygon_of_shape
from fairyring.model.photo import read
from fairyring.storage.contents import (
    load_annotation,
    load_annotations,
    load_prediction,
)
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Prediction, Run

SIDE = 240
"""Height and width of a close-up, pixels."""
AROUND = 1.5
"""Side of what it shows of the photo, in sides of the cap's box."""
WIDE = 1000
"""Longer side of a whole photo, pixels."""
MARKED, PREDICTED = (255, 200, 0), (255, 0, 255)
"""Colours, blue first: what people marked, what was predicted."""
FRACTION_BITS = 4
"""OpenCV draws at sixteenths of a pixel."""

Picture = NDArray[np.uint8]


@dataclass(frozen=True, kw_only=True)
class _View:
    """The square of a photo that a close-up shows: its corner, and how much it is enlarged."""

    x: float
    y: float
    scale: float


def close_ups(project: Project, caps: list[ReviewedCap]) -> list[str]:
    """Each cap as an address that holds the picture itself; empty where its photo cannot be read."""
    photos: dict[int, Picture | None] = {}
    addresses = []
    for cap in caps:
        if cap.image not in photos:
            photos[cap.image] = _photo(project, cap.image)
        photo = photos[cap.image]
        addresses.append("" if photo is None else _address(_close_up(project, cap, photo)))
    return addresses


def side_by_side(project: Project, image_id: int, *, run: Run | None = None) -> list[str]:
    """A whole photo three times, as in Figures 17 and 18 of the paper: marked contours, predicted ones, both.

    Centres are drawn, too, on the first the numbers of the caps, and on the last the lines between the two
    centres of one cap. Empty where the photo is gone.

    Args:
        project: whose image.
        image_id: which one.
        run: whose predictions; None for the latest ones.
    """
    photo = _photo(project, image_id)
    if photo is None:
        return []
    with project.read() as connection:
        said = load_annotations(connection, image_id)
        guessed = predictions_of(connection, image_id, run=run)
        image = get_image(connection, image_id)
    pairs = compare(
        [truth_record(each, image) for each in said],
        [prediction_record(each, image) for each in guessed],
        width=image.width,
        height=image.height,
    ).pairs
    scale = min(1.0, WIDE / max(photo.shape[:2]))
    size = round(photo.shape[1] * scale), round(photo.shape[0] * scale)
    small = np.ascontiguousarray(cv2.resize(photo, size, interpolation=cv2.INTER_AREA), np.uint8)
    view = _View(x=0.0, y=0.0, scale=scale)
    addresses = []
    for shown in ((said,), (guessed,), (said, guessed)):
        picture = small.copy()
        for each in (cap for caps in shown for cap in caps):
            _draw_centred(picture, each, view)
        if shown == (said,):
            _number(picture, said, view)
        for pair in pairs if len(shown) == 2 else ():
            marked, predicted = said[pair.truth].centre, guessed[pair.prediction].centre
            if marked is not None and predicted is not None:
                _line(picture, marked, predicted, view)
        addresses.append(_address(picture))
    return addresses


def _number(picture: Picture, caps: Sequence[Annotation], view: _View) -> None:
    """Writes beside each centre, light on dark, the number that its cap has in the plots."""
    for nth, cap in enumerate(caps, start=1):
        if cap.centre is None:
            continue
        (at,) = np.rint((np.array([cap.centre]) - (view.x, view.y)) * view.scale + (5, -5)).astype(int)
        for colour, thick in (((0, 0, 0), 3), ((255, 255, 255), 1)):
            place = int(at[0]), int(at[1])
            cv2.putText(picture, str(nth), place, cv2.FONT_HERSHEY_SIMPLEX, 0.55, colour, thick, cv2.LINE_AA)


def _draw_centred(picture: Picture, cap: Annotation | Prediction, view: _View) -> None:
    colour = MARKED if isinstance(cap, Annotation) else PREDICTED
    _draw(picture, _outline_of(cap), view, colour)
    if cap.centre is not None:
        (at,) = _placed(np.array([cap.centre]), view)
        cv2.circle(picture, at, 2 * 2**FRACTION_BITS, colour, -1, cv2.LINE_AA, FRACTION_BITS)


def _photo(project: Project, image_id: int) -> Picture | None:
    with project.read() as connection:
        image = get_image(connection, image_id)
    try:
        return read(project.originals.path_of(image))
    except StoreError:
        return None


def _close_up(project: Project, cap: ReviewedCap, photo: Picture) -> Picture:
    row = cap.measured.row
    with project.read() as connection:
        said = load_annotation(connection, str(row.truth))
        guessed = load_prediction(connection, int(row.prediction)) if row.prediction is not None else None
    assert said is not None, "a measured cap is an annotation"
    view = _view_of(_outline_of(said))
    picture = _cut(photo, view)
    for each, colour in ((said, MARKED), (guessed, PREDICTED)):
        if each is not None:
            _draw(picture, _outline_of(each), view, colour)
    if said.centre is not None and guessed is not None and guessed.centre is not None:
        _join(picture, said.centre, guessed.centre, view)
    return picture


def _outline_of(cap: Annotation | Prediction) -> Outline:
    """The whole outline, else what is visible."""
    visible = cap.cap.visible if isinstance(cap, Annotation) else cap.visible
    return [polygon_of_shape(cap.whole)] if cap.whole is not None else visible


def _view_of(outline: Outline) -> _View:
    x0, y0, x1, y1 = boxes_of_outlines([outline])[0].tolist()
    side = AROUND * max(x1 - x0, y1 - y0, 1.0)
    return _View(x=(x0 + x1 - side) / 2, y=(y0 + y1 - side) / 2, scale=SIDE / side)


def _cut(photo: Picture, view: _View) -> Picture:
    # A pixel's centre lies at a half; OpenCV's warps count from there.
    move = np.array([[view.scale, 0, 0], [0, view.scale, 0]])
    move[:, 2] = view.scale * (0.5 - np.array([view.x, view.y])) - 0.5
    cut = cv2.warpAffine(photo, move, (SIDE, SIDE), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_CONSTANT)
    return np.ascontiguousarray(cut, np.uint8)


def _placed(points: NDArray[np.float64], view: _View) -> NDArray[np.int32]:
    """Points (n, 2) of the photo in a close-up, in OpenCV's sixteenths of a pixel."""
    there = (points - (view.x, view.y)) * view.scale - 0.5
    return np.rint(there * 2**FRACTION_BITS).astype(np.int32)


def _draw(picture: Picture, outline: Outline, view: _View, colour: tuple[int, int, int]) -> None:
    parts = [_placed(points_of_part(part), view) for part in outline]
    cv2.polylines(picture, parts, True, colour, 1, cv2.LINE_AA, FRACTION_BITS)


def _line(picture: Picture, marked: Centre, predicted: Centre, view: _View) -> None:
    ends = _placed(np.array([marked, predicted]), view)
    cv2.line(picture, ends[0], ends[1], (255, 255, 255), 1, cv2.LINE_AA, FRACTION_BITS)


def _join(picture: Picture, marked: Centre, predicted: Centre, view: _View) -> None:
    _line(picture, marked, predicted, view)
    ends = _placed(np.array([marked, predicted]), view)
    for end, colour in zip(ends, (MARKED, PREDICTED), strict=True):
        cv2.circle(picture, end, 3 * 2**FRACTION_BITS, colour, -1, cv2.LINE_AA, FRACTION_BITS)


def _address(picture: Picture) -> str:
    # Thin coloured lines fade where JPEG keeps colours at half the resolution.
    whole = [cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444]
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 85, *whole])
    return "data:image/jpeg;base64," + base64.b64encode(data.tobytes()).decode()
