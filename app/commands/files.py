"""JSON files that commands write, and the names of those they read."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fairyring.model.errors import FairyringError, FileError


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
