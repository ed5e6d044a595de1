"""docs/architecture.md: a newcomer's finger must find what its walks name."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import dedent

import pytest

from tests.unit.test_arrows import DRAWINGS

TOP = Path(__file__).parents[2]
PAGES = ["README.md", *(f"docs/{page.name}" for page in (TOP / "docs").glob("*.md"))]
FILE = re.compile(r"`((?:app|model|storage|static|tests|docs)/[\w/]+\.(?:py|js|md|json|toml))`")
NAME_IN_FILE = re.compile(r"`(\w+)` in\s+`([\w/]+\.(?:py|js))`")


@pytest.mark.parametrize("page", PAGES)
def test_every_file_that_a_page_names_is_there(page: str) -> None:
    named = FILE.findall((TOP / page).read_text(encoding="utf-8"))
    assert [path for path in named if not (TOP / path).exists()] == []


def test_every_function_of_the_walks_is_made_in_the_file_they_name() -> None:
    text = (TOP / "docs" / "architecture.md").read_text(encoding="utf-8")
    named = NAME_IN_FILE.findall(text)
    assert len(named) >= 20
    assert [f"{name} in {path}" for name, path in named if not _makes(TOP / path, name)] == []


def test_the_page_shows_the_rooms_as_the_arrows_test_holds_them() -> None:
    text = (TOP / "docs" / "architecture.md").read_text(encoding="utf-8")
    source = (TOP / "tests" / "js" / "arrows.test.js").read_text(encoding="utf-8")
    editor = re.search(r"const DRAWING = `(.*?)`", source, re.DOTALL)
    assert editor is not None
    for drawing in [*DRAWINGS.values(), editor.group(1)]:
        assert f"```\n{dedent(drawing).strip()}\n```" in text


def _makes(file: Path, name: str) -> bool:
    """Whether a file holds a class, function or method of this name."""
    python = rf"^\s*(?:async )?(?:def|class) {name}\b"
    javascript = rf"^\s*(?:export )?(?:async )?(?:function|class) {name}\b|^  (?:async )?{name}\("
    return re.search(f"{python}|{javascript}", file.read_text(encoding="utf-8"), re.MULTILINE) is not None


def test_no_two_decisions_have_one_number() -> None:
    numbers = [record.name[:4] for record in (TOP / "docs" / "decisions").glob("*.md")]
    assert sorted(numbers) == [f"{number:04}" for number in range(1, len(numbers) + 1)]
