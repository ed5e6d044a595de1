"""What was done to an image, newest first."""

from fairyring.storage.records import Cap
from tests.support.image_changes import do, history_of
from tests.unit.storage.conftest import SQUARE, TRIANGLE

THERE, MOVED = Cap(visible=SQUARE), Cap(visible=TRIANGLE)


def test_the_history_counts_what_became_of_caps(beds):
    do(beds, "drawn", ("a", 0, THERE), ("b", 0, THERE), ("c", 0, THERE))
    do(beds, "changed", ("a", 1, MOVED), ("b", 1, None), user="bob")
    do(beds, "back", ("b", 2, THERE))
    do(beds, "rejected", ("d", 0, THERE), ("d", 1, None))
    told = [
        (s.user, s.made, s.changed, s.deleted, s.brought_back, s.turned_down)
        for s in history_of(beds).change_sets
    ]
    assert told == [
        ("ann", 0, 0, 0, 0, 1),
        ("ann", 0, 0, 0, 1, 0),
        ("bob", 0, 1, 1, 0, 0),
        ("ann", 3, 0, 0, 0, 0),
    ]


def test_the_history_comes_in_pages(beds):
    do(beds, "s0", ("a", 0, THERE))
    for number in range(1, 25):
        do(beds, f"s{number}", ("a", number, MOVED if number % 2 else THERE))
    page = history_of(beds, offset=20, limit=10)
    assert (page.total, len(page.change_sets), page.change_sets[-1].made) == (25, 5, 1)


def test_a_change_that_gives_a_cap_a_predicted_outline_names_the_run(predicted):
    do(predicted, "drawn", ("a", 0, MOVED))
    do(predicted, "taken", ("a", 1, THERE))
    do(predicted, "flagged", ("a", 2, Cap(visible=SQUARE, doubtful=True)))
    told = history_of(predicted).change_sets
    assert [each.outline_of for each in told] == [None, "r", None]
