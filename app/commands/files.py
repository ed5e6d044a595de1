"""JSON files that commands read and write."""

from __future__ import annotations

import gzip
import json
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fairyring.model.errors import FairyringError


class FileError(FairyringError):
    """A file that cannot be read or written."""


def read_json(path: Path) -> Any:
    """The JSON in a file, gzipped or not; FileError with its name where there is none."""
    try:
        raw = path.read_bytes()
        return json.loads(gzip.decompress(raw) if raw[:2] == b"\x1f\x8b" else raw)
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}.") from error
    except (ValueError, EOFError, zlib.error, RecursionError) as error:
        raise FileError(f"{path} is not a JSON file, or was cut off; export it again.") from error


def write_json(document: Any, path: Path) -> None:
    """Writes beside and renames, so that a file is there whole or not at all."""
    raw = json.dumps(document).encode()
    beside = path.with_name(path.name + ".part")
    try:
        beside.write_bytes(gzip.compress(raw, mtime=0) if path.suffix == ".gz" else raw)
        beside.replace(path)
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}.") from error


@contextmanager
def named(*paths: Path) -> Iterator[None]:
    """Puts the files' names before what is wrong with them."""
    try:
        yield
    except FairyringError as error:
        raise about(error, *paths) from error


def about(error: FairyringError, *paths: Path) -> FileError:
    """The same with the names of the files that it may be about."""
    return FileError(f"{' or '.join(map(str, paths))}: {error}")
