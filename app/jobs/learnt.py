"""What was learnt from the corrections in a project, and whether it is used.

Each training has a folder of its own in the project's cache, and says there what it was and what it brought.
The weights are used once somebody puts them into the project's ``weights``, and can be taken out again.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import msgspec
from msgspec import Struct

from fairyring.app.weights import weights_of
from fairyring.storage.folder import WEIGHTS
from fairyring.storage.project import Project

FOLDER, REPORT, PREFIX = "learning", "learnt.json", "corrections-"
FIGURES = ("AP", "AP50", "AP75", "AR", "S50", "P", "R")
"""Figures of ``evaluate masks`` that are compared."""


class Learnt(Struct, frozen=True, kw_only=True):
    """What a training on corrections brought."""

    name: str
    base: str
    """Name of the weights that it started from."""
    weights: str
    """Path of the weights that it made."""
    photos: str
    """Of what it learnt, in a sentence."""
    held_out: int
    """Photos that both weights were validated on; 0 where there were too few to hold any back."""
    before: dict[str, float]
    after: dict[str, float]


def latest_learnt(project: Project) -> Learnt | None:
    """What the last finished training brought; None where there was none, or its weights are gone."""
    for folder in reversed(folders_of(project)):
        try:
            learnt = msgspec.json.decode((folder / REPORT).read_bytes(), type=Learnt)
        except (OSError, msgspec.MsgspecError):
            continue
        return learnt if Path(learnt.weights).exists() else None
    return None


def use_learnt(project: Project, learnt: Learnt) -> Path:
    """Has the project predicted with what was learnt; returns where the weights lie now."""
    used = project.folder / WEIGHTS / f"{learnt.name}.safetensors"
    used.parent.mkdir(exist_ok=True)
    partial = used.with_suffix(".partial")
    # A copy made now is the newest there, which is the one that is taken.
    shutil.copyfile(learnt.weights, partial)
    partial.replace(used)
    return used


def can_go_back(project: Project) -> bool:
    """Whether the project is predicted with what was learnt from its corrections."""
    now = weights_of(project)
    return now is not None and now.parent == project.folder / WEIGHTS and now.name.startswith(PREFIX)


def go_back(project: Project) -> Path | None:
    """Takes out what was learnt last; returns the weights of before. It stays in its training's folder."""
    now = weights_of(project)
    if now is not None and can_go_back(project):
        now.unlink()
    return weights_of(project)


def folders_of(project: Project) -> list[Path]:
    """Of all trainings, the latest last."""
    found = (project.cache / FOLDER).glob(f"{PREFIX}*")
    return sorted(found, key=lambda folder: int(folder.name.removeprefix(PREFIX)))


def new_folder(project: Project) -> Path:
    """Makes the folder of another training."""
    before = folders_of(project)
    number = int(before[-1].name.removeprefix(PREFIX)) + 1 if before else 1
    folder = project.cache / FOLDER / f"{PREFIX}{number}"
    folder.mkdir(parents=True)
    return folder
