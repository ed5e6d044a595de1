"""Single values out of JSON that nobody vouches for, each as its type says or refused with a sentence."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable
from typing import Any
from unicodedata import normalize

import msgspec

from fairyring.model.errors import FairyringError

MOST_PIXELS = 1_000_000
"""Longest side of an image, pixels."""
MOST_BYTES_OF_A_NAME = 200


class ValueRefusedError(FairyringError):
    """A value that cannot be taken; the sentence says what is wrong with it, not where it stands."""


def number(value: Any, what: str) -> float:
    """A finite real number, no boolean. Raises ValueRefusedError."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        try:
            figure = float(value)
        except OverflowError:
            figure = math.inf
        if math.isfinite(figure):
            return figure
    raise ValueRefusedError(f"{what} is not a finite number.")


def numbers(value: Any, what: str, *, count: int) -> list[float]:
    """A list of exactly ``count`` finite numbers. Raises ValueRefusedError."""
    if isinstance(value, list) and len(value) == count:
        try:
            return [number(item, what) for item in value]
        except ValueRefusedError:
            pass
    raise ValueRefusedError(f"{what} is not {count} finite numbers.")


def size(value: Any, what: str) -> int | None:
    """A positive whole number of pixels, or None where it is missing. Raises ValueRefusedError."""
    if value is None:
        return None
    if type(value) is float and value.is_integer():
        value = int(value)
    if type(value) is not int or not 0 < value < MOST_PIXELS:
        raise ValueRefusedError(f"{what} is not a positive whole number.")
    return value


FLAGS = {"0": False, "1": True, "false": False, "true": True}
"""The values of flags as text, which some programs write."""


def flag(value: Any, key: str) -> bool:
    """True, False, 1 or 0, also as text; missing is False. Raises ValueRefusedError, which names the key."""
    if value is None or value is False or value is True:
        return bool(value)
    if type(value) in (int, float) and value in (0, 1):
        return bool(value)
    if isinstance(value, str) and value.lower() in FLAGS:
        return FLAGS[value.lower()]
    raise ValueRefusedError(f"“{key}” is neither true nor false.")


def base_name(value: Any) -> str:
    """The last part of a path of any system; folders in it are ignored, so nothing can be reached by it.

    In Unicode's composed form: a Mac keeps the ü of a name as two characters, other systems as one.

    Raises ValueRefusedError where there is none.
    """
    if not isinstance(value, str):
        raise ValueRefusedError("The file name is missing.")
    name = normalize("NFC", value.replace("\\", "/").rsplit("/", 1)[-1])
    too_long = len(name.encode(errors="replace")) > MOST_BYTES_OF_A_NAME
    if name in ("", ".", "..") or not name.isprintable() or too_long:
        raise ValueRefusedError(f"{value[:60]!r} is no file name.")
    return name


def kept(extra: dict[str, Any], *, left_out: Callable[[str], None]) -> dict[str, Any]:
    """The unknown keys that can be written again; ``left_out`` hears of each of the others."""
    if not extra or _is_writable(extra):
        return extra
    good = {key: value for key, value in extra.items() if _is_writable({key: value})}
    for key in extra.keys() - good.keys():
        left_out(f"Its {shown(key)} cannot be kept: it holds half a character or a number beyond 64 bits.")
    return good


def _is_writable(value: Any) -> bool:
    try:
        msgspec.json.encode(value)
    except (UnicodeError, OverflowError, RecursionError, msgspec.MsgspecError):
        return False
    return True


def text(value: Any) -> str | None:
    """A short line of text, or None where it is something else."""
    return value if isinstance(value, str) and value.isprintable() and 0 < len(value) <= 100 else None


def shown(value: Any) -> str:
    """A value as a message may show it: short, and printable on any terminal."""
    short = str(value)[:40] if isinstance(value, str | int | float) else reprlib.repr(value)
    return short if short.isprintable() else ascii(short)
