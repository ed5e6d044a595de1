"""The weights that a project is predicted with: its own newest, else the shipped ones."""

from __future__ import annotations

from pathlib import Path

from safetensors import SafetensorError, safe_open

from fairyring.model.errors import FairyringError
from fairyring.model.predict.shipped import SHIPPED
from fairyring.storage.folder import WEIGHTS
from fairyring.storage.project import Project


def weights_of(project: Project) -> Path | None:
    """Path of the newest weights in the project's ``weights``, else of the shipped ones; None without any."""
    own = sorted((file.stat().st_mtime, file) for file in (project.folder / WEIGHTS).glob("*.safetensors"))
    if own:
        return own[-1][1]
    return SHIPPED if SHIPPED.exists() else None


def digest_in(weights: Path) -> str:
    """The digest that stands in a file of weights, read without loading them; empty where there is none."""
    try:
        with safe_open(weights, "numpy") as opened:
            return (opened.metadata() or {}).get("digest", "")
    except (OSError, SafetensorError):
        return ""


def require_weights(project: Project) -> Path:
    """As ``weights_of``; raises FairyringError with the remedy where there are none."""
    found = weights_of(project)
    if found is None:
        raise FairyringError(
            f"There are no weights to predict with; put a .safetensors file that fairyring train made "
            f"into {project.folder / WEIGHTS}, or name it with --weights."
        )
    return found
