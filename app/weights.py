"""Which weights a project's photos are read with: its own newest, else those that come with Fairyring."""

from __future__ import annotations

from pathlib import Path

from fairyring.model.errors import FairyringError
from fairyring.model.predict.shipped import SHIPPED
from fairyring.storage.project import Project


def weights_of(project: Project) -> Path | None:
    """The newest in the project's ``weights`` folder, else the shipped ones; None where there are none."""
    own = sorted((file.stat().st_mtime, file) for file in (project.folder / "weights").glob("*.safetensors"))
    if own:
        return own[-1][1]
    return SHIPPED if SHIPPED.exists() else None


def require_weights(project: Project) -> Path:
    """``weights_of``, or FairyringError with the remedy."""
    found = weights_of(project)
    if found is None:
        raise FairyringError(
            f"There are no weights to predict with; put a .safetensors file that fairyring train made "
            f"into {project.folder / 'weights'}, or name it with --weights."
        )
    return found
