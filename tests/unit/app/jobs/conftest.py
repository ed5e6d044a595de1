"""Labels to learn from, and a recipe that is done in a blink."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from tests.support.sighted import RECIPE
from tests.support.tab import new_cap
from tests.unit.app.conftest import circle


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    path = tmp_path / "recipe.toml"
    path.write_text(RECIPE)
    return path


@pytest.fixture
def labelled(project: Project) -> Project:
    """One cap in each of the first two photos; that in the first is at its second revision."""
    annotate(project, 1, uid="one", visible=circle(40, 40, 20))
    annotate(project, 1, uid="one", base=1, edit="again", visible=circle(41, 40, 21))
    annotate(project, 2, uid="two", visible=circle(100, 60, 25))
    return project


def annotate(project: Project, image: int, *, uid: str, edit: str = "", base: int = 0, **cap: object) -> None:
    made = new_cap(image, uid=uid, edit=edit or uid, base=base, **cap)
    (outcome,) = commit(project, [Derived(edit=made)], user="Ada")
    assert type(outcome).__name__ == "Accepted", outcome
