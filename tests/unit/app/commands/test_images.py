"""The commands take-out, put-back, relink and info."""

import json

import pytest
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.model.errors import FairyringError
from fairyring.storage.project import create_project
from tests.strangers.bed import photo, write
from tests.strangers.coco import caps, document, image


def run(*arguments):
    done = CliRunner().invoke(app, [*map(str, arguments)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done


@pytest.fixture
def beds(tmp_path):
    """A project of three linked photos, the first with two caps."""
    for moved, name in enumerate(("bed_1.jpg", "bed_2.jpg", "other.jpg")):
        photo(tmp_path / "photos" / name, moved=moved)
    write(tmp_path / "photos" / "labels.json", document([image(split="train")], caps(circle=[60, 70, 30])))
    create_project(tmp_path / "beds").close()
    run("import", tmp_path / "beds", tmp_path / "photos", "--link", "--by", "ann")
    return tmp_path / "beds"


def figures(project):
    return json.loads(run("info", project, "--json").stdout)


def test_info_says_what_a_project_holds(beds):
    found = figures(beds)
    assert found["status"] == {"new": 3, "annotated": 0, "approved": 0}
    assert found["splits"] == {"": 2, "train": 1}
    assert (found["images"], found["linked"], found["caps"], found["marks"]) == (3, 3, 2, 2)
    assert [(person["name"], person["edits"]) for person in found["people"]] == [("ann", 2)]
    assert found["disk"]["database"] > 10_000
    said = run("info", beds).stdout
    assert "beds: 3 images (3 new, 0 annotated, 0 approved); 3 linked" in said
    assert "caps: 2, 2 of them with a mark" in said


def test_images_are_taken_out_by_pattern_and_put_back(beds):
    assert "2 images with 2 annotations" in run("take-out", beds, "bed_*").stdout
    assert (figures(beds)["images"], figures(beds)["taken_out"]) == (1, 2)
    assert "bed_1.jpg" in run("put-back", beds, "bed_1.jpg").stdout
    assert (figures(beds)["images"], figures(beds)["caps"]) == (2, 2)
    run("put-back", beds)
    assert figures(beds)["images"] == 3
    with pytest.raises(FairyringError, match="Nothing is put back"):
        run("put-back", beds)
    with pytest.raises(FairyringError, match="is called nothing; check the name"):
        run("take-out", beds, "bed_1.jpg", "nothing")
    assert figures(beds)["images"] == 3


def test_photos_that_moved_are_linked_anew(beds, tmp_path):
    (tmp_path / "photos").rename(tmp_path / "moved")
    assert run("relink", beds, tmp_path / "moved").stdout == "Photos found: 3; still missing: 0\n"
    (tmp_path / "moved" / "other.jpg").unlink()
    done = run("relink", beds, tmp_path / "moved")
    assert done.exit_code == 1
    assert "other.jpg is in none of these folders." in done.stderr


def test_a_name_is_found_however_its_letters_are_composed_and_the_undoing_can_be_pasted(tmp_path):
    project = tmp_path / "my beds"
    create_project(project).close()
    run("import", project, photo(tmp_path / "bed_\u00e9.jpg"))
    assert f"fairyring put-back '{project}'" in run("take-out", project, "bed_e\u0301*").stderr
    assert figures(project)["taken_out"] == 1


def test_of_two_of_one_name_that_were_taken_out_the_number_says_which(tmp_path):
    create_project(tmp_path / "beds").close()
    for moved in (0, 1):
        run("import", tmp_path / "beds", photo(tmp_path / "in" / "bed.jpg", moved=moved))
        run("take-out", tmp_path / "beds", "bed.jpg")
    with pytest.raises(FairyringError, match=r"taken out 2 times; give the number of one: 2 .* 1 \(0 caps"):
        run("put-back", tmp_path / "beds")
    run("put-back", tmp_path / "beds", 1)
    assert (figures(tmp_path / "beds")["images"], figures(tmp_path / "beds")["taken_out"]) == (1, 1)
