"""Work as somebody who is not root, whom permissions hold back."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

NOBODY = 65534


@contextmanager
def nobody() -> Iterator[None]:
    """This process as nobody, if it was root."""
    before = os.geteuid()
    if before == 0:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        os.seteuid(before)


@contextmanager
def open_folder() -> Iterator[Path]:
    """A folder that everybody may reach and write to, as they may not reach what tests are given."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o777)
    try:
        yield folder
    finally:
        make_writable(folder)
        shutil.rmtree(folder)


def make_read_only(folder: Path) -> None:
    """Lets everybody look at a folder and what is in it, and nobody write."""
    for path in (*folder.rglob("*"), folder):
        path.chmod(0o555 if path.is_dir() else 0o444)


def make_writable(folder: Path) -> None:
    """Lets everybody do everything with a folder and what is in it."""
    for path in (folder, *folder.rglob("*")):
        path.chmod(0o777)


def state_of(folder: Path) -> dict[str, tuple[int, int]]:
    """Size and time of writing of everything in a folder."""
    found = {}
    for path in sorted(folder.rglob("*")):
        stat = path.stat()
        found[str(path.relative_to(folder))] = (stat.st_size, stat.st_mtime_ns)
    return found
