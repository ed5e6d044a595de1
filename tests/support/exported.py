"""Caps put into a project, and the document that its export writes."""

import json

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Edit
from fairyring.storage.runs import require_run

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
TRIANGLE = [40.0, 40.0, 60.0, 40.0, 50.0, 60.0]


def store(project, *caps, image=1, **derived):
    edits = [
        Edit(id=f"{image} {n}", annotation=f"{image}_{n}", image=image, base=0, cap=cap)
        for n, cap in enumerate(caps)
    ]
    outcomes = commit(project, [Derived(edit=edit, fit=Fit(**derived)) for edit in edits], user="ann")
    assert all(type(outcome).__name__ == "Accepted" for outcome in outcomes), outcomes


def export(project, out, *, run=None, **keys):
    if run is not None:
        with project.read() as connection:
            keys["run"] = require_run(connection, run)
    report = export_coco(project, out, Wanted(**keys))
    document = json.loads((out / "instances.json").read_text())
    assert (report.images, report.annotations) == (len(document["images"]), len(document["annotations"]))
    return document
