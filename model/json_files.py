"""JSON that comes from outside: unzipped and decoded, or refused with a sentence.

Beyond what JSON allows, NaN and infinities come through, so that only the item that holds one is refused.
"""

from __future__ import annotations

import gzip
import io
import json
import math
import zlib
from pathlib import Path
from typing import Any

import msgspec

from fairyring.model.errors import FairyringError, FileError

GZIP = b"\x1f\x8b"
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
MOST_BYTES = 4 << 30
"""Most bytes that a file is unzipped to: a few kilobytes can hold any number of zeros."""
MOST_DIGITS = 4300
"""Most digits of a whole number; one with more, which Python would not read, becomes infinity."""


class JsonError(FairyringError):
    """A text that is not JSON; the sentence does not name the file."""


def read_json(path: Path) -> Any:
    """The value in a JSON file, gzipped or not. Raises FileError, which names the file."""
    data = read_file(path)
    try:
        return parse_json(unzipped(data))
    except JsonError as error:
        raise FileError(f"{path}: {error}") from error


def read_file(path: Path) -> bytes:
    """The bytes of a file as they are. Raises FileError, which names the file."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}.") from error


def unzipped(data: bytes) -> bytes:
    """The bytes, decompressed where they are gzip's. Raises JsonError where those are damaged."""
    if not data.startswith(GZIP):
        return data
    try:
        plain = gzip.GzipFile(fileobj=io.BytesIO(data)).read(MOST_BYTES + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise JsonError("This is a damaged gzip file, or it was cut off; export it again.") from error
    if len(plain) > MOST_BYTES:
        raise JsonError(f"This unzips to more than {MOST_BYTES >> 30} GB; divide the file.")
    return plain


def parse_json(data: bytes) -> Any:
    """The value of a JSON text in UTF-8, 16 or 32, with or without byte order mark. Raises JsonError."""
    try:
        return msgspec.json.decode(data.removeprefix(BYTE_ORDER_MARK))
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return parse_loosely(data)


def parse_loosely(data: bytes) -> Any:
    """``parse_json`` by the slower parser, which knows NaN, infinity, half characters and large numbers."""
    try:
        return json.loads(data, parse_int=_whole_number)
    except RecursionError as error:
        raise JsonError("This is nested too deeply to be a file of labels.") from error
    except ValueError as error:
        raise JsonError(f"This is not JSON, or it was cut off ({error}); export it again.") from error


def _whole_number(digits: str) -> int | float:
    if len(digits) <= MOST_DIGITS:
        return int(digits)
    return -math.inf if digits.startswith("-") else math.inf
