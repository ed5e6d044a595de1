"""Two marked caps with their predictions, and one that no network saw, in a photo of 160 × 120."""

from __future__ import annotations

from fairyring.app.caps.filling_in import fill_in
from fairyring.model.geometry.shapes import Circle, Fit, fit_of_shape
from fairyring.storage.contents import load_predictions
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from fairyring.storage.records import Edit
from tests.support.tab import new_cap
from tests.unit.app.conftest import circle


def mark_both(project: Project) -> None:
    """Marks the left cap 1.6 px left of and 0.6 px below its prediction's centre, the right one on it."""
    fill_in(project)
    with project.read() as connection:
        left, right = load_predictions(connection, 1)
    centres = {"left": (left.centre[0] - 1.6, left.centre[1] + 0.6), "right": right.centre}
    outlines = {"left": circle(40, 40, 20), "right": circle(110, 60, 25)}
    edits = [
        new_cap(1, uid=uid, edit=uid, visible=outlines[uid], mark=Circle(*centre, 20))
        for uid, centre in centres.items()
    ]
    far = new_cap(1, uid="far", edit="far", visible=circle(75, 105, 8))
    commit(project, [Derived(edit=edit, fit=_fit(edit)) for edit in (*edits, far)], user="Ada")


def _fit(edit: Edit) -> Fit:
    mark = edit.cap.mark if edit.cap else None
    return fit_of_shape(mark) if isinstance(mark, Circle) else Fit()
