"""Plain beds that Ada has annotated, with what a network said of them: they differ where a test knows it."""

from __future__ import annotations

from pathlib import Path

from fairyring.app.caps.filling_in import fill_in
from fairyring.model.geometry.shapes import Circle, Fit, fit_of_shape
from fairyring.storage.contents import load_predictions
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Cap, Edit, StatusEdit
from tests.support.plain_bed import SIZE, make_bed, ring

PLACES = ((80, 80), (220, 90), (360, 80), (500, 100), (120, 260))
RADIUS = 40.0
SHIFT = 8.0
"""Ada marked the second cap of each photo so many pixels to the right of where it was predicted."""
CDR = 100 * SHIFT / SIZE[0]


def make_annotated_beds(folder: Path, *, count: int) -> Path:
    """A project of ``count`` photos with five predictions each.

    Ada accepted and marked the first four, the second one ``SHIFT`` to the right; she drew a sixth that
    nobody predicted, left the fifth open, and said that each photo is annotated.
    """
    path = make_bed(folder, [[ring(x, y, RADIUS) for x, y in PLACES]] * count, said=True)
    with open_project(path) as project:
        fill_in(project)
        for image in range(1, count + 1):
            _annotate(project, image)
    return path


def _annotate(project: Project, image: int) -> None:
    with project.read() as connection:
        said = load_predictions(connection, image)
    caps = []
    for number, each in enumerate(said[:4]):
        assert each.centre is not None
        mark = Circle(each.centre[0] + (SHIFT if number == 1 else 0.0), each.centre[1], RADIUS)
        caps.append(Cap(visible=each.visible, mark=mark, prediction=each.id))
    caps.append(Cap(visible=[ring(400, 300, RADIUS)], mark=Circle(400, 300, RADIUS)))
    edits = [
        Edit(id=f"e{image}-{number}", annotation=uid_of(image, number), image=image, base=0, cap=cap)
        for number, cap in enumerate(caps)
    ]
    done = StatusEdit(id=f"done-{image}", image=image, before="new", after="annotated")
    derived = [Derived(edit=edit, fit=_fit(edit)) for edit in edits]
    commit(project, derived, statuses=[done], user="Ada")


def _fit(edit: Edit) -> Fit:
    assert edit.cap is not None
    assert isinstance(edit.cap.mark, Circle)
    return fit_of_shape(edit.cap.mark)


def uid_of(image: int, number: int) -> str:
    """The uid of a cap of Ada's: 0 to 3 were predicted, 4 was not."""
    return f"cap-{image}-{number}"
