"""Names of the files in a project's folder. Light to import: commands look before they load more."""

from __future__ import annotations

from pathlib import Path

SETTINGS = "fairyring.toml"
DATABASE = "project.db"
IMAGES = "images"
WEIGHTS = "weights"
CACHE = "cache"
TAKEN_OUT = "taken_out"
NOTE_OF_BACKUP = "backup.json"


def is_project(folder: Path) -> bool:
    """Whether ``folder`` has been made a project."""
    return (folder / SETTINGS).exists()
