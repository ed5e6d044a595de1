"""Checks whether a cap, as somebody sent it, is fit to be stored."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from msgspec import UNSET, structs

from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.outline_checks import check_mark, check_outline
from fairyring.model.geometry.told_arcs import check_told_arcs
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Cap

SHOWN = 40
"""How many characters of a name that is refused are shown."""
MAX_NAME = 200
MAX_ORDER = 1_000_000


def check_cap(cap: Cap, *, width: int, height: int, left_out: Callable[[str], object] | None = None) -> Cap:
    """The cap with its mark in standard form, its visible outline put right, and what was said of arcs of it.

    Where the outline crosses itself it is repaired; it ends where the image does, which a mark need not.

    Args:
        cap: outline and mark in pixels of the upright image; one of the two must be there.
        width: of the image, pixels.
        height: of the image, pixels.
        left_out: hears which of several parts cannot be used; without it that is an error.

    Raises:
        GeometryError: not finite, too few points or far too many, far outside the image, without area.
        StoreError: neither outline nor mark, or an overlap order beyond ``MAX_ORDER``.
    """
    if not cap.visible and cap.mark is None:
        raise StoreError("A cap needs a visible outline or a mark.")
    if cap.order is not None and abs(cap.order) > MAX_ORDER:
        raise StoreError(f"The overlap order lies between -{MAX_ORDER} and {MAX_ORDER}.")
    check_name(cap.category, "category")
    mark = None if cap.mark is None else check_mark(cap.mark, width=width, height=height)
    visible = cap.visible and check_outline(cap.visible, width=width, height=height, left_out=left_out)
    inside = visible and clipped_outline(visible, width=width, height=height)
    arcs = check_told_arcs(cap.told, inside) if cap.told and inside else []
    return structs.replace(cap, visible=inside, mark=mark, arcs=arcs or UNSET)


def is_name(text: str) -> bool:
    """Whether this is a short, printable, single line."""
    return 0 < len(text) <= MAX_NAME and text.isprintable()


def check_name(text: str, what: str) -> str:
    """The name, if it is a short, printable, single line.

    Raises:
        StoreError: empty, longer than ``MAX_NAME`` or with control characters.
    """
    if not is_name(text):
        raise StoreError(f"A {what} is 1 to {MAX_NAME} printable characters; {_what_is_wrong_with(text)}.")
    return text


def _what_is_wrong_with(text: str) -> str:
    if not text:
        return "this is empty"
    if len(text) > MAX_NAME:
        return f"{text[:SHOWN]}… has {len(text)}"
    return f"{text!r:.{SHOWN}} has others"


def are_finite(numbers: Sequence[float]) -> bool:
    """Whether all are real numbers: not NaN, not infinite, no booleans."""
    return all(type(value) in (int, float) and math.isfinite(value) for value in numbers)
