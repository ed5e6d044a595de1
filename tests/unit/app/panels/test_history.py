"""What people did to an image, in words."""

from fairyring.app.panels.history import words_of
from fairyring.storage.image_history import ChangeSet
from fairyring.storage.records import Cap

BEFORE = Cap(visible=[[0.0, 0.0, 8.0, 0.0, 0.0, 8.0]])
AFTER = Cap(visible=[[0.0, 0.0, 9.0, 0.0, 0.0, 9.0]], doubtful=True)


def changed(**more):
    return ChangeSet(number=1, user="ann", made_at="", changed=1, first=("u", BEFORE, AFTER), **more)


def test_an_outline_that_was_predicted_is_called_that_of_its_run():
    assert words_of(changed()) == "changed the outline of a cap and set a cap to doubtful"
    taken = changed(outline_of="Bea")
    assert words_of(taken) == "took Bea’s outline of a cap and set a cap to doubtful"


def test_an_outline_that_comes_back_by_undoing_was_not_taken():
    undone = changed(outline_of="Bea", kind="undone")
    assert words_of(undone) == "took back: changed the outline of a cap and set a cap to doubtful"
