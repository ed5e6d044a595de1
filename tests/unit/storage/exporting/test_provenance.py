"""An export says where its labels come from, and the same of one state every time."""

from hashlib import sha256

from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Edit
from tests.support.exported import SQUARE, TRIANGLE, export, store


def predicted(project):
    """A run called lite0 that saw one cap in the first image; returns the prediction's number."""

    def predict(connection):
        run = add_run(connection, name="lite0", kind="network")
        said = NewPrediction(visible=[SQUARE], score=0.75)
        add_predictions(connection, run_id=run.id, image_id=1, predictions=[said])

    project.write(predict)
    return 1


def moved(project, *, by, base=1):
    cap = Cap(visible=[[value + base for value in SQUARE]])
    commit(
        project,
        [Derived(edit=Edit(id=f"e{base}", annotation="1_0", image=1, base=base, cap=cap))],
        user=by,
    )


def test_a_cap_says_who_edited_it_when_how_often_and_which_prediction_it_was(beds, out):
    number = predicted(beds)
    store(beds, Cap(visible=[SQUARE], prediction=number), Cap(visible=[TRIANGLE]))
    moved(beds, by="ben")
    first, second = export(beds, out)["annotations"]
    assert (first["edited_by"], first["revision"]) == ("ben", 2)
    assert first["edited_at"].startswith("20")
    assert (second["edited_by"], second["revision"], "prediction" in second) == ("ann", 1, False)


def test_a_cap_keeps_its_prediction_as_long_as_it_says_so(beds, out):
    number = predicted(beds)
    store(beds, Cap(visible=[SQUARE], prediction=number))
    (annotation,) = export(beds, out)["annotations"]
    assert annotation["prediction"] == {"id": number, "run": "lite0", "score": 0.75}


def test_what_a_file_says_of_who_made_a_cap_stands_until_it_is_edited(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]))
    (mine,) = export(beds, out)["annotations"]
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out])
        (copy,) = export(other, tmp_path / "copy")["annotations"]
        assert copy == mine
        moved(other, by="eve")
        (edited,) = export(other, tmp_path / "edited")["annotations"]
    assert (edited["edited_by"], edited["revision"]) == ("eve", 2)


def test_an_image_has_the_sha256_of_its_exported_file(beds, out):
    store(beds, Cap(visible=[SQUARE]))
    for image in export(beds, out, only="all")["images"]:
        assert image["sha256"] == sha256((out / "images" / image["file_name"]).read_bytes()).hexdigest()


def test_the_head_says_who_worked_on_it_until_when_and_under_which_licence(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]))
    moved(beds, by="ben")
    info = export(beds, out, license="CC-BY-4.0")["info"]
    assert (info["contributors"], info["contributor"]) == (["ann", "ben"], "ann, ben")
    assert (info["version"], info["license"]) == ("2", "CC-BY-4.0")
    assert info["date_created"].startswith(str(info["year"]))
    assert info["written_by"].startswith("Fairyring ")
    moved(beds, by="ben", base=2)
    again = export(beds, tmp_path / "again")["info"]
    assert (again["version"], again["date_created"] >= info["date_created"]) == ("3", True)
    assert "license" not in again


def test_without_a_word_the_licence_is_that_of_the_photos(beds, out, write_coco):
    images = [{"id": 1, "file_name": "bed_1.png", "license": 4}]
    path = write_coco([{"segmentation": [SQUARE]}], images=images, licenses=[{"id": 4, "name": "MIT"}])
    import_paths(beds, [path])
    assert export(beds, out)["info"]["license"] == "MIT"
