"""The visible part of a cap, polygons or an RLE, checked against the image's size: as outline or as mask."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fairyring.model.coco.annotations import Segmentation
from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import Rle, check_rle, rle_of_outline
from fairyring.model.geometry.rle import checked_counts
from fairyring.model.geometry.shapes import GeometryError, Outline


def outline_in(
    segmentation: Segmentation,
    *,
    width: int,
    height: int,
    left_out: Callable[[str], object] | None = None,
) -> Outline:
    """The outline in an image of this size, fit to be stored or drawn.

    ``left_out`` hears which of several parts of it cannot be used, and how many specks of a noisy mask were
    left out; without it one such part is an error, and in any case if there is no other part. Raises
    GeometryError.
    """
    if isinstance(segmentation, dict):
        check_size(segmentation, width=width, height=height)
        return outline_of_rle(segmentation, left_out=left_out or (lambda _what: None))
    return check_outline(segmentation, width=width, height=height, left_out=left_out)


def rle_in(segmentation: Segmentation, *, width: int, height: int) -> Rle:
    """The visible pixels as an RLE, perhaps none. Raises GeometryError."""
    if isinstance(segmentation, dict):
        check_size(segmentation, width=width, height=height)
        return check_rle(segmentation)
    outline = check_outline(segmentation, width=width, height=height)
    return rle_of_outline(outline, width=width, height=height)


def counts_in(rle: dict[str, Any], *, width: int, height: int) -> list[int]:
    """The counts of an RLE, as ``checked_counts`` gives them. Raises GeometryError."""
    check_size(rle, width=width, height=height)
    return checked_counts(rle)[2]


def check_size(rle: dict[str, Any], *, width: int, height: int) -> None:
    """Raises GeometryError for an RLE of an image of another size, before that is decoded, which costs."""
    size = rle.get("size")
    if isinstance(size, list) and size != [height, width]:
        raise GeometryError(f"Its mask is not of the image's size, {width} × {height}.")
