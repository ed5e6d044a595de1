"""Is a cap, as somebody sent it, fit to be stored?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from msgspec import structs

from fairyring.model.geometry.raster import check_mark, check_outline
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Cap

MAX_PARTS = 500
MAX_POINTS = 20_000
MAX_NAME = 200
MAX_ORDER = 1_000_000


def check_cap(cap: Cap, *, width: int, height: int) -> Cap:
    """The cap with its visible outline repaired where it crosses itself, and its mark in standard form.

    Args:
        cap: outline and mark in pixels of the upright image; one of the two must be there.
        width: of the image, pixels.
        height: of the image, pixels.

    Raises:
        GeometryError: not finite, too few points, far outside the image, without area.
        StoreError: too large, neither outline nor mark, or an overlap order beyond ``MAX_ORDER``.
    """
    if not cap.visible and cap.mark is None:
        raise StoreError("A cap needs a visible outline or a mark.")
    if len(cap.visible) > MAX_PARTS or sum(map(len, cap.visible)) > 2 * MAX_POINTS:
        raise StoreError(f"An outline has at most {MAX_PARTS} parts and {MAX_POINTS} points.")
    if cap.order is not None and abs(cap.order) > MAX_ORDER:
        raise StoreError(f"The overlap order lies between -{MAX_ORDER} and {MAX_ORDER}.")
    check_name(cap.category, "category")
    mark = None if cap.mark is None else check_mark(cap.mark, width=width, height=height)
    visible = check_outline(cap.visible, width=width, height=height) if cap.visible else []
    return structs.replace(cap, visible=visible, mark=mark)


def check_name(text: str, what: str) -> str:
    """A short, printable, one-line name.

    Raises:
        StoreError: empty, longer than ``MAX_NAME`` or with control characters.
    """
    if not text or len(text) > MAX_NAME or not text.isprintable():
        raise StoreError(f"A {what} is 1 to {MAX_NAME} printable characters.")
    return text


def are_finite(numbers: Sequence[float]) -> bool:
    """Real numbers, none of them NaN, infinite or a boolean in disguise."""
    return all(type(value) in (int, float) and math.isfinite(value) for value in numbers)
