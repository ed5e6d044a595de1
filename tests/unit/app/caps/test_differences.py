"""Where annotations and predictions differ, the first to be looked at first."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.app.caps.differences import differences_of
from fairyring.storage.contents import load_annotations, load_predictions
from fairyring.storage.images import get_image
from fairyring.storage.project import open_project
from tests.support.annotated_beds import CDR, make_annotated_beds, uid_of


def test_caps_without_counterpart_come_first_then_the_mark_that_is_off(tmp_path: Path) -> None:
    with open_project(make_annotated_beds(tmp_path, count=1)) as project, project.read() as connection:
        image = get_image(connection, 1)
        annotations, predictions = load_annotations(connection, 1), load_predictions(connection, 1)
        found = differences_of(image, annotations, predictions)
        assert differences_of(image, annotations, []) == []
    assert [each.annotation for each in found[:3]] == [uid_of(1, 4), None, uid_of(1, 1)]
    assert found[0].prediction is None
    assert found[1].prediction == predictions[4]
    assert found[2].cdr == pytest.approx(CDR, abs=0.01)
    assert len(found) == 6
    assert all(each.iou == pytest.approx(1.0) for each in found[2:])
