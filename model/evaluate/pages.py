"""COCO documents and result lists as evaluation reads them: images paired, each cap with mask and centre.

Both sides come from outside and are checked; what cannot be used raises DocumentError and says where.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PureWindowsPath
from typing import Any, Literal

from msgspec import Struct
from msgspec.structs import replace

from fairyring.model.contour.marks import whole_of_mark
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.mask_tracing import rim_of_mask
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import Rle, check_rle, rle_of_outline
from fairyring.model.geometry.rle import checked_counts, cut_of_counts
from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    GeometryError,
    Polygon,
    Shape,
    canonical_ellipse,
    centre_of_shape,
    diameter_of_shape,
    part_of_points,
)

ELLIPSE_FIGURES = 5
CIRCLE_FIGURES = 3


class DocumentError(FairyringError):
    """A document that cannot be evaluated; the sentence names the item, not the file."""

    side: Literal["predicted", "truth"] | None = None
    """Whose document it is; None where the two do not fit together."""


class CapRecord(Struct, frozen=True, kw_only=True):
    """One cap, true or predicted, as far as evaluation is concerned."""

    id: int | str | None = None
    rle: Rle | None = None
    """Visible pixels; None where caps are paired by id."""
    score: float = 1.0
    """Of a prediction; finite."""
    centre: Centre | None = None
    """None where nobody marked it, or a method refused it."""
    diameter: float | None = None
    """Pixels, of the whole cap."""
    ignored: bool = False
    """Truth only: the cap counts neither way."""


class Page(Struct, frozen=True, kw_only=True):
    """One image of the truth, with what was predicted there."""

    file_name: str
    """Base name."""
    width: int
    height: int
    truths: list[CapRecord]
    predictions: list[CapRecord]
    light: str | None = None
    form: str | None = None


class _Image(Struct, frozen=True, kw_only=True):
    id: int | str
    file_name: str
    width: int
    height: int
    light: str | None
    form: str | None


def pages_of(predicted: Any, truth: Any, *, masks: bool, centres: bool) -> list[Page]:
    """The truth's images in its order, with the caps of both sides.

    Images are paired by base file name; a result list, which names none, goes by the other side's image ids.
    Without ``masks`` no segmentation is read and every cap must have an id. Without ``centres`` caps have
    none, and a diameter only where a circle or an ellipse is stated. Raises DocumentError.
    """
    with _blamed_on("truth"):
        true_images, of_truth = _images(truth), _annotations(truth)
    with _blamed_on("predicted"):
        predicted_images, of_prediction = _images(predicted), _annotations(predicted)
    if true_images is None and predicted_images is None:
        raise DocumentError(
            "Neither side lists images, and their sizes are needed; give a COCO file with images."
        )
    listed = true_images if true_images is not None else predicted_images or {}
    pages = []
    for name, image in listed.items():
        other = (predicted_images or listed).get(name)
        if other is not None and (other.width, other.height) != (image.width, image.height):
            raise DocumentError(
                f"{name} has different sizes in the two files; they must show the same photo."
            )
        with _blamed_on("truth"):
            truths = _caps(of_truth.get(image.id, []), image, masks=masks, centres=centres)
        with _blamed_on("predicted"):
            entries = of_prediction.get(other.id, []) if other else []
            predictions = _caps(entries, image, masks=masks, centres=centres)
        pages.append(
            Page(
                file_name=name,
                width=image.width,
                height=image.height,
                truths=truths,
                predictions=predictions,
                light=image.light,
                form=image.form,
            )
        )
    return pages


@contextmanager
def _blamed_on(side: Literal["predicted", "truth"]) -> Iterator[None]:
    try:
        yield
    except DocumentError as error:
        error.side = side
        raise


def _images(document: Any) -> dict[str, _Image] | None:
    """By base name; None for a result list."""
    if isinstance(document, list):
        return None
    if not isinstance(document, dict) or not isinstance(document.get("images"), list):
        raise DocumentError("This is neither a COCO file with images nor a list of results.")
    images: dict[str, _Image] = {}
    for entry in document["images"]:
        image = _image(entry)
        if image.file_name in images:
            raise DocumentError(f"Two images are called {image.file_name}; base file names must differ.")
        images[image.file_name] = image
    return images


def _image(entry: Any) -> _Image:
    if not isinstance(entry, dict) or not isinstance(entry.get("file_name"), str):
        raise DocumentError("An image has no file name.")
    # Both kinds of slash part folders here, whatever machine wrote the file.
    name = PureWindowsPath(entry["file_name"]).name
    width, height = entry.get("width"), entry.get("height")
    if type(width) is not int or type(height) is not int or width < 1 or height < 1:
        raise DocumentError(f"The image {name} has no proper width and height.")
    if not isinstance(entry.get("id"), int | str):
        raise DocumentError(f"The image {name} has no id.")
    light, form = (_text(entry.get(key)) for key in ("light", "form"))
    return _Image(id=entry["id"], file_name=name, width=width, height=height, light=light, form=form)


def _text(value: Any) -> str | None:
    return value if isinstance(value, str) else None


def _annotations(document: Any) -> dict[int | str, list[dict[str, Any]]]:
    """By image id."""
    entries = document if isinstance(document, list) else document.get("annotations", [])
    if not isinstance(entries, list):
        raise DocumentError("The annotations are not a list.")
    grouped: dict[int | str, list[dict[str, Any]]] = defaultdict(list)
    for entry in entries:
        if not isinstance(entry, dict) or not isinstance(entry.get("image_id"), int | str):
            raise DocumentError("An annotation does not say which image it belongs to.")
        grouped[entry["image_id"]].append(entry)
    return grouped


def _caps(entries: list[dict[str, Any]], image: _Image, *, masks: bool, centres: bool) -> list[CapRecord]:
    caps = []
    for entry in entries:
        where = f"Annotation {entry.get('id', '(without id)')} of {image.file_name}"
        try:
            cap = _cap(entry, image, masks=masks)
            caps.append(_with_centre(cap, entry, image) if centres else cap)
        except (GeometryError, DocumentError) as error:
            raise DocumentError(f"{where}: {error}") from error
    if not masks:
        _check_ids(caps, image)
    return caps


def _check_ids(caps: list[CapRecord], image: _Image) -> None:
    ids = [cap.id for cap in caps]
    if None in ids or len(set(ids)) < len(ids):
        raise DocumentError(f"The annotations of {image.file_name} need an id each to be paired by it.")


def _cap(entry: dict[str, Any], image: _Image, *, masks: bool) -> CapRecord:
    identifier, shape = entry.get("id"), _shape(entry)
    return CapRecord(
        id=identifier if isinstance(identifier, int | str) else None,
        rle=_rle(entry.get("segmentation"), image) if masks else None,
        score=_score(entry),
        diameter=diameter_of_shape(shape) if shape else None,
        ignored=any(bool(entry.get(key)) for key in ("ignore", "ignored", "iscrowd")),
    )


def _with_centre(cap: CapRecord, entry: dict[str, Any], image: _Image) -> CapRecord:
    shape, centre = _shape(entry), _figures(entry, "center", 2)
    if shape is None and cap.rle is not None and not entry.get("refusal"):
        shape = _fitted(entry.get("segmentation"), image)
    if entry.get("refusal"):
        centre = None
    elif centre is None and shape is not None:
        centre = centre_of_shape(shape)
    return replace(
        cap,
        centre=(float(centre[0]), float(centre[1])) if centre else None,
        diameter=diameter_of_shape(shape) if shape else _diameter_of_box(entry),
    )


def _score(entry: dict[str, Any]) -> float:
    """A shape without a score was drawn by somebody who was sure."""
    score = entry.get("score")
    if score is None:
        return 1.0
    if not _is_finite(score):
        raise DocumentError("Its score is not a finite number; correct it, or leave it out to count as 1.")
    return float(score)


def _shape(entry: dict[str, Any]) -> Shape | None:
    """The whole outline the annotation states: its circle before its ellipse."""
    if circle := _figures(entry, "circle", CIRCLE_FIGURES):
        return Circle(*circle)
    if ellipse := _figures(entry, "ellipse", ELLIPSE_FIGURES):
        return canonical_ellipse(*ellipse)
    return None


def _figures(entry: dict[str, Any], key: str, count: int) -> list[float] | None:
    value = entry.get(key)
    if value is None:
        return None
    if not isinstance(value, list | tuple) or len(value) != count or not all(map(_is_finite, value)):
        raise DocumentError(f"Its {key} is not {count} finite numbers.")
    return [float(figure) for figure in value]


def _is_finite(figure: Any) -> bool:
    """Whether it is a number that a float can hold; no comparison holds for NaN."""
    return type(figure) in (int, float) and abs(figure) <= sys.float_info.max


def _rle(segmentation: Any, image: _Image) -> Rle:
    if isinstance(segmentation, list):
        outline = check_outline(segmentation, width=image.width, height=image.height)
        return rle_of_outline(outline, width=image.width, height=image.height)
    rle = check_rle(segmentation)
    if rle["size"] != [image.height, image.width]:
        raise DocumentError(f"Its mask is not of the image's size, {image.width} × {image.height}.")
    return rle


def _fitted(segmentation: Any, image: _Image) -> Shape | None:
    """The ellipse fitted to the polygon's vertices, of all its parts together, or to the rim of an RLE."""
    if isinstance(segmentation, list):
        outline = check_outline(segmentation, width=image.width, height=image.height)
        return whole_of_mark(Polygon([figure for part in outline for figure in part]))
    height, _, counts = checked_counts(segmentation)
    cut, corner = cut_of_counts(height, counts)
    return whole_of_mark(Polygon(part_of_points(rim_of_mask(cut) + corner)))


def _diameter_of_box(entry: dict[str, Any]) -> float | None:
    """The longer side: of a cap that is partly hidden, more often than not still its diameter."""
    box = _figures(entry, "bbox", 4)
    return max(box[2:]) or None if box else None
