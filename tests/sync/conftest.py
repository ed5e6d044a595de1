"""A project with one photo, copied for every trace, and a tab that shows it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from pathlib import Path

import pytest

from fairyring.storage.project import open_project
from fairyring.storage.records import Rules
from fairyring.storage.rules import set_rules
from tests.support.browser_side import BrowserSide
from tests.support.plain_bed import make_empty_bed
from tests.support.two_sides import TwoSides

Begin = Callable[[], AbstractContextManager[TwoSides]]


@pytest.fixture(scope="session")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_empty_bed(tmp_path_factory.mktemp("sync"))


@pytest.fixture(scope="session")
def browser() -> Iterator[BrowserSide]:
    with BrowserSide() as started:
        yield started


@pytest.fixture(scope="session")
def begin(made_once: Path, browser: BrowserSide, tmp_path_factory: pytest.TempPathFactory) -> Begin:
    """Starts a trace: an empty image, and a tab that shows it."""

    @contextmanager
    def begin_() -> Iterator[TwoSides]:
        folder = tmp_path_factory.mktemp("trace")
        with open_project(shutil.copytree(made_once, folder / "beds")) as project:
            # One person does everything here.
            project.write(partial(set_rules, rules=Rules(approve_own=True)))
            yield TwoSides(project, browser)
        shutil.rmtree(folder)

    return begin_


@pytest.fixture
def sides(begin: Begin) -> Iterator[TwoSides]:
    with begin() as both:
        yield both
