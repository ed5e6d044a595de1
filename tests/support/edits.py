"""Edits in a line each, and what the journal has of them."""

import sqlite3

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Edit


def edit(
    number="e1", *, annotation="cap", image=1, base=0, cap=None, change_set="", takes_back="", **derived
):
    whence = {"change_set": change_set, "takes_back": takes_back}
    made = Edit(id=number, annotation=annotation, image=image, base=base, cap=cap, **whence)
    return Derived(edit=made, fit=Fit(**derived))


def one(project, *args, user="ann", **kwargs):
    (outcome,) = commit(project, [edit(*args, **kwargs)], user=user)
    return outcome


def journal_rows(project):
    with sqlite3.connect(project.folder / "project.db") as connection:
        return connection.execute(
            "SELECT id, annotation, base, revision, user FROM edit ORDER BY sequence"
        ).fetchall()
