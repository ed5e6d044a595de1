"""Which caps people are asked to mark again, and that second marks are no labels."""

from __future__ import annotations

import json

import pytest

from fairyring.model.geometry.shapes import Circle
from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from fairyring.storage.records import Cap, Edit, Mark, Repeat, Rules
from fairyring.storage.repeats import all_repeats, due_repeat, store_repeat
from fairyring.storage.rules import set_rules
from tests.support.edits import one

MARK = Circle(20.0, 20.0, 10.0)


def ask(project: Project, *, share: float = 1.0, seed: int = 1) -> None:
    rules = Rules(repeat_share=share, repeat_seed=seed)
    project.write(lambda connection: set_rules(connection, rules))


def due(project: Project, user: str = "ann", *, besides: int | None = None) -> tuple[str, int, bool] | None:
    with project.read() as connection:
        found = due_repeat(connection, user=user, besides=besides)
    return None if found is None else (found.annotation, found.left, found.mirrored)


def again(number: str = "r1", *, first: Mark = MARK) -> Repeat:
    return Repeat(
        id=number,
        annotation="cap",
        image=1,
        user="ann",
        mirrored=True,
        first=first,
        second=Circle(21.0, 20.0, 10.0),
        size="m",
        visibility=None,
    )


@pytest.fixture
def marked(beds, square):
    """A cap that ann marked."""
    one(beds, "e1", cap=Cap(visible=square, mark=MARK))
    return beds


def test_nothing_is_asked_for_unless_the_project_wants_it(marked) -> None:
    assert due(marked) is None
    ask(marked)
    assert due(marked) == ("cap", 1, True)


def test_who_placed_the_mark_is_asked_and_not_while_the_image_is_on_screen(marked, square) -> None:
    ask(marked)
    assert due(marked, "ben") is None
    assert due(marked, besides=1) is None
    one(marked, "e2", base=1, cap=Cap(visible=square, mark=MARK, doubtful=True), user="ben")
    assert due(marked, "ben") is None


def test_a_mark_that_somebody_takes_away_and_puts_back_is_still_of_who_placed_it(marked, square) -> None:
    ask(marked)
    one(marked, "e2", base=1, cap=Cap(visible=square), user="ben", change_set="taken")
    assert due(marked) is None
    one(marked, "e3", base=2, cap=Cap(visible=square, mark=MARK), user="ben", takes_back="taken")
    assert due(marked) == ("cap", 1, True)
    assert due(marked, "ben") is None


def test_a_share_of_the_caps_is_chosen_by_the_seed(beds, square) -> None:
    edits = [
        Edit(id=f"e{n}", annotation=f"c{n}", image=1, base=0, cap=Cap(visible=square, mark=MARK))
        for n in range(400)
    ]
    commit(beds, [Derived(edit=edit) for edit in edits], user="ann")
    found = []
    for seed in (1, 2):
        ask(beds, share=0.1, seed=seed)
        found.append(due(beds))
    (first, of_first, _), (second, _, _) = found
    assert 25 < of_first < 56
    assert first != second


def test_a_second_mark_is_kept_once_and_the_cap_not_asked_for_again(marked) -> None:
    ask(marked)
    for _ in range(2):
        marked.write(lambda connection: store_repeat(connection, again()))
    with marked.read() as connection:
        assert all_repeats(connection) == [(again(), 100, 80)]
    assert due(marked) is None
    with pytest.raises(StoreError, match="marked again before"):
        marked.write(lambda connection: store_repeat(connection, again("r2")))


def test_a_second_mark_of_a_mark_that_is_gone_is_refused(marked) -> None:
    with pytest.raises(StoreError, match="another one by now"):
        marked.write(lambda connection: store_repeat(connection, again(first=Circle(9.0, 9.0, 5.0))))
    with marked.read() as connection:
        assert all_repeats(connection) == []


def test_second_marks_are_never_exported(marked, tmp_path) -> None:
    marked.write(lambda connection: store_repeat(connection, again()))
    export_coco(marked, tmp_path / "out", Wanted())
    (cap,) = json.loads((tmp_path / "out" / "instances.json").read_text())["annotations"]
    assert cap["circle"] == [20.0, 20.0, 10.0]
    assert "21.0" not in (tmp_path / "out" / "instances.json").read_text()
