"""Which split a photo belongs to by the folders it lies in: ``train/``, ``valid/``, ``test/`` and such."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from fairyring.model.splits import Split, split_called

SplitOf = Callable[[Path], Split | None]
"""The split of a photo by its path; None where that says nothing."""


def folders_say_nothing(_photo: Path) -> None:
    """A ``SplitOf`` for photos whose folders are not looked at."""
    return


def split_folders(named: Sequence[Path]) -> SplitOf:
    """Reads splits from folders below those that a person named, the innermost first.

    A folder that was named itself, or lies above, counts only where one of another split lies beside it:
    somebody's folder ``test`` may hold anything.
    """
    roots = [_plain(path) for path in named if path.is_dir()]
    has_others_beside = cache(_has_others_beside)

    def split_of(photo: Path) -> Split | None:
        for folder in _plain(photo).parents:
            split = split_called(folder.name)
            if split is not None and (_lies_below(folder, roots) or has_others_beside(folder)):
                return split
        return None

    return split_of


def split_in_name(file_name: str) -> Split | None:
    """The split that a file of labels writes as a folder before a photo's name.

    A whole path tells of somebody's disk, not of the data set.
    """
    folders = file_name.replace("\\", "/").split("/")[:-1]
    if folders and (not folders[0] or folders[0].endswith(":")):
        return None
    return next((split for folder in reversed(folders) if (split := split_called(folder))), None)


def _plain(path: Path) -> Path:
    return Path(os.path.normpath(path.absolute()))


def _lies_below(folder: Path, roots: Sequence[Path]) -> bool:
    return any(root in folder.parents for root in roots)


def _has_others_beside(folder: Path) -> bool:
    own = split_called(folder.name)
    try:
        beside = [other.name for other in folder.parent.iterdir() if other.is_dir()]
    except OSError:
        return False
    return any(split_called(name) not in (None, own) for name in beside)
