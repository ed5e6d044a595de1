"""Change sets of an image, and how its history tells of them."""

from fairyring.storage.image_history import list_change_sets
from fairyring.storage.journal import commit
from tests.support.edits import edit


def do(project, change_set, *edits, takes_back="", user="ann"):
    """A change set of edits, each (uid, base, cap)."""
    named = {"change_set": change_set, "takes_back": takes_back}
    made = [
        edit(f"{change_set}-{n}", annotation=u, base=b, cap=c, **named) for n, (u, b, c) in enumerate(edits)
    ]
    return commit(project, made, user=user)


def history_of(project, **page):
    with project.read() as connection:
        return list_change_sets(connection, 1, **page)
