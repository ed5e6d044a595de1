"""What lies in a project's folder under which name. Light to import: a command asks before it loads more."""

from __future__ import annotations

from pathlib import Path

SETTINGS = "fairyring.toml"
DATABASE = "project.db"
IMAGES = "images"


def is_project(folder: Path) -> bool:
    """Whether ``folder`` has been made a project."""
    return (folder / SETTINGS).exists()
