"""Single values out of JSON that nobody vouches for."""

from __future__ import annotations

import json
import math
from typing import Any

import msgspec

from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import UnusableError


def read_json(data: bytes, *, file: str) -> Any:
    """The document; NaN and Infinity come through, so that only the item that holds them is refused.

    Raises:
        StoreError: it is not JSON.
    """
    data = data.removeprefix(b"\xef\xbb\xbf")
    try:
        return msgspec.json.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError):
        pass  # msgspec knows no NaN: the slower parser decides
    except RecursionError as error:
        raise StoreError(f"{file} is nested too deeply to be a file of labels.") from error
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as error:
        raise StoreError(f"{file} is not valid JSON ({error}); export it anew.") from error


def number(value: Any, what: str) -> float:
    """A finite real number, no boolean.

    Raises:
        UnusableError: it is something else.
    """
    if type(value) not in (int, float):
        raise UnusableError(f"{what} is not a number.")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise UnusableError(f"{what} is not finite.")
    return result


def numbers(value: Any, what: str, *, count: int) -> list[float]:
    """A list of exactly ``count`` finite numbers.

    Raises:
        UnusableError: it is something else.
    """
    if not isinstance(value, list) or len(value) != count:
        raise UnusableError(f"{what} is not a list of {count} numbers.")
    return [number(item, what) for item in value]


def size(value: Any, what: str) -> int | None:
    """A positive whole number of pixels, or None where it is missing.

    Raises:
        UnusableError: it is something else.
    """
    if value is None:
        return None
    if type(value) is float and value.is_integer():
        value = int(value)
    if type(value) is not int or not 0 < value < 1_000_000:
        raise UnusableError(f"{what} is not a positive whole number.")
    return value


def flag(value: Any, what: str) -> bool:
    """True, False, 1 or 0; missing is False.

    Raises:
        UnusableError: it is something else.
    """
    if value is None or value is False or value is True:
        return bool(value)
    if type(value) is int and value in (0, 1):
        return bool(value)
    raise UnusableError(f"{what} is neither true nor false.")


def base_name(value: Any) -> str:
    """The last part of a path of any system; folders in it are ignored, so nothing can be reached by it.

    Raises:
        UnusableError: there is none.
    """
    if not isinstance(value, str):
        raise UnusableError("The file name is missing.")
    name = value.replace("\\", "/").rsplit("/", 1)[-1]
    if name in ("", ".", "..") or not name.isprintable() or len(name.encode(errors="replace")) > 200:
        raise UnusableError(f"{value[:60]!r} is no file name.")
    return name


def kept(extra: dict[str, Any]) -> dict[str, Any]:
    """Unknown keys, if they can be written again.

    Raises:
        UnusableError: they hold half characters or numbers beyond 64 bits.
    """
    try:
        msgspec.json.encode(extra)
    except (UnicodeError, OverflowError, RecursionError, msgspec.MsgspecError) as error:
        raise UnusableError(f"Its other keys cannot be kept: {error}.") from error
    return extra


def text(value: Any) -> str | None:
    """A short line of text, or None where it is something else."""
    return value if isinstance(value, str) and value.isprintable() and 0 < len(value) <= 100 else None
