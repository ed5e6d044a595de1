"""Verdicts go out with the image or cap they are about, and come back as they were written."""

import json

from fairyring.storage.exporting import export_coco
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Verdict
from tests.support.edits import one


def test_verdicts_are_written_and_survive_a_second_project(beds, square, tmp_path):
    one(beds, "e1", cap=Cap(visible=square))
    said = [
        Verdict(id="v1", image=1, annotation="cap", says="comment", words="Is it one?"),
        Verdict(id="v2", image=1, says="approved"),
    ]
    commit(beds, [], verdicts=said, user="rev")
    export_coco(beds, tmp_path / "out")
    document = json.loads((tmp_path / "out" / "instances.json").read_text())
    (image,) = [each for each in document["images"] if each["id"] == 1]
    (cap,) = [each for each in document["annotations"] if each["uid"] == "cap"]
    assert [(v["says"], v["words"], v["by"]) for v in image["verdicts"]] == [("approved", "", "rev")]
    assert [(v["says"], v["words"], v["by"], v["revision"]) for v in cap["verdicts"]] == [
        ("comment", "Is it one?", "rev", 1)
    ]
    with create_project(tmp_path / "second") as second:
        import_paths(second, [tmp_path / "out" / "instances.json"])
        export_coco(second, tmp_path / "again")
    again = json.loads((tmp_path / "again" / "instances.json").read_text())
    (same,) = [each for each in again["annotations"] if each["uid"] == "cap"]
    assert same["verdicts"] == cap["verdicts"]
    (photo,) = [each for each in again["images"] if each["file_name"] == image["file_name"]]
    assert photo["verdicts"] == image["verdicts"]


def test_an_export_that_comes_back_says_no_verdict_twice(beds, square, tmp_path):
    one(beds, "e1", cap=Cap(visible=square))
    commit(beds, [], verdicts=[Verdict(id="v1", image=1, says="approved")], user="rev")
    export_coco(beds, tmp_path / "out")
    import_paths(beds, [tmp_path / "out"])
    export_coco(beds, tmp_path / "again")
    again, before = (
        json.loads((tmp_path / folder / "instances.json").read_text()) for folder in ("again", "out")
    )
    assert again["images"] == before["images"]
