"""What tests of faults share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project of two photos, bed.png and good.png, to be copied."""
    folder = tmp_path_factory.mktemp("fuzz")
    for number, name in enumerate(("bed.png", "good.png")):
        PIL.Image.fromarray(np.full((120, 160, 3), 90 + number, np.uint8)).save(folder / name)
    with create_project(folder / "beds") as project:
        import_paths(project, [folder / "bed.png", folder / "good.png"])
    return folder / "beds"
