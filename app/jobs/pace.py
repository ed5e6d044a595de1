"""How long an image takes to predict on this machine, as the last ones took. Kept in the project's cache."""

from __future__ import annotations

from contextlib import suppress

import msgspec

from fairyring.storage.project import Project

KEPT = "pace.json"
LATEST = 0.3
"""Weight of the image that was predicted last."""


def note_pace(project: Project, seconds: float) -> None:
    """Notes how long an image has just taken."""
    before = seconds_an_image(project)
    now = seconds if before is None else (1 - LATEST) * before + LATEST * seconds
    # It is a guess for people to read; a full disk is somebody else's news.
    with suppress(OSError):
        project.cache.mkdir(parents=True, exist_ok=True)
        (project.cache / KEPT).write_bytes(msgspec.json.encode(now))


def seconds_an_image(project: Project) -> float | None:
    """How long an image takes; None where nothing was predicted here yet."""
    try:
        return msgspec.json.decode((project.cache / KEPT).read_bytes(), type=float)
    except (OSError, msgspec.MsgspecError):
        return None
