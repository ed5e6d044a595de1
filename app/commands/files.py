"""Files that commands write, and the names of those they read."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from fairyring.model.errors import FairyringError, FileError
from fairyring.model.whole_files import written_whole


def write_json(document: Any, path: Path) -> None:
    """Writes a JSON file, gzipped if its name says so, whole or not at all. Raises FileError."""
    raw = json.dumps(document).encode()
    write_bytes(gzip.compress(raw, mtime=0) if path.suffix == ".gz" else raw, path)


def write_bytes(data: bytes, path: Path) -> None:
    """Writes a file whole or not at all. Raises FileError."""
    try:
        with written_whole(path) as fresh:
            fresh.write_bytes(data)
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}.") from error


def require_other_file(out: Path, *read: Path, option: str = "--out") -> None:
    """Raises BadParameter where a command would write over a file that it reads."""
    if any(path.exists() and out.exists() and path.samefile(out) for path in read):
        raise typer.BadParameter(f"{out} is read by this command; name another file.", param_hint=option)


@contextmanager
def named(*paths: Path) -> Iterator[None]:
    """Puts the names of files before the errors raised in the block."""
    try:
        yield
    except FairyringError as error:
        raise about(error, *paths) from error


def about(error: FairyringError, *paths: Path) -> FileError:
    """The error with the names of the files that it may be about."""
    return FileError(f"{' or '.join(map(str, paths))}: {error}")


def is_same_file(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file that is there, by whatever names and links."""
    try:
        return path.samefile(other)
    except OSError:
        return False
