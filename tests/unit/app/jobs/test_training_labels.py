"""Which labels are learnt, from a project or from COCO files, and what is kept to check on."""

from __future__ import annotations

import json
from collections import Counter
from hashlib import sha256
from pathlib import Path

from fairyring.app.jobs.division import divided
from fairyring.app.jobs.training_labels import Labels, labels_at, labels_of_project
from fairyring.model.geometry.shapes import Circle
from fairyring.model.network.weights import load_weights
from fairyring.storage.exporting import export_coco
from fairyring.storage.project import Project
from fairyring.storage.splits import set_splits
from fairyring.storage.statuses import set_status
from tests.support.terminal import sentence, train
from tests.unit.app.conftest import circle
from tests.unit.app.jobs.conftest import annotate


def reasons(labels: Labels) -> Counter[str]:
    """How many photos teach nothing, by the reason."""
    return Counter(each.why for each in labels.left_out)


def test_approved_images_alone_are_learnt_once_there_are_some(labelled: Project) -> None:
    labelled.write(lambda connection: set_status(connection, 2, "approved", user="Ada"))
    assert [example.path.name for example in labels_of_project(labelled).examples] == ["bed_2.jpg"]


def test_caps_that_nobody_is_sure_of_are_left_out_of_what_is_learnt(project: Project) -> None:
    annotate(project, 1, uid="sure", visible=circle(40, 40, 20))
    annotate(project, 1, uid="doubtful", visible=circle(100, 40, 15), doubtful=True)
    annotate(project, 1, uid="ignored", visible=circle(100, 80, 10), ignored=True)
    annotate(project, 1, uid="mark", visible=[], mark=Circle(50.0, 90.0, 12.0))
    (example,) = labels_of_project(project).examples
    assert len(example.caps) == 1
    assert example.caps[0][0][:2] == [60.0, 40.0]
    assert len(example.ignored) == 3
    xs = [x for outline in example.ignored for x in outline[0][0::2]]
    assert (round(min(xs)), round(max(xs))) == (38, 115)


def test_a_coco_file_is_learnt_from_with_its_photos_beside_it_and_in_images(
    labelled: Project, tmp_path: Path
) -> None:
    export_coco(labelled, tmp_path / "coco")
    file = tmp_path / "coco" / "instances.json"
    (tmp_path / "coco" / "images" / "bed_1.jpg").rename(tmp_path / "coco" / "bed_1.jpg")
    labels = labels_at([file])
    assert [example.path for example in labels.examples] == [
        tmp_path / "coco" / "bed_1.jpg",
        tmp_path / "coco" / "images" / "bed_2.jpg",
    ]
    assert [len(example.caps) for example in labels.examples] == [1, 1]
    (record,) = labels.record["files"]
    assert record["sha256"] == sha256(file.read_bytes()).hexdigest()


def test_several_files_are_learnt_from_and_validated_on_in_turn_though_their_photos_share_names(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    sets = [tmp_path / name for name in ("first", "second")]
    for folder in sets:
        export_coco(labelled, folder)
    first, second = files = [folder / "instances.json" for folder in sets]
    only = json.loads(second.read_text())
    only["images"], only["annotations"] = only["images"][:1], only["annotations"][:1]
    second.write_text(json.dumps(only))
    one, two, three = (
        sets[0] / "images" / "bed_1.jpg",
        sets[0] / "images" / "bed_2.jpg",
        sets[1] / "images" / "bed_1.jpg",
    )
    assert [example.path for example in labels_at(files).examples] == [one, two, three]
    assert [example.path for example in labels_at(files, in_turn=True).examples] == [one, three, two]

    out = tmp_path / "run"
    done = train(
        first, out, second, "--val", first, "--val", second, "--config", recipe, "--weights", "imagenet"
    )
    assert done.exit_code == 0, done.output
    record = json.loads((out / "labels.json").read_bytes())
    digests = [sha256(file.read_bytes()).hexdigest() for file in files]
    assert [one["sha256"] for one in record["files"]] == digests
    assert [one["sha256"] for one in record["validation"]["files"]] == digests
    assert load_weights(out / "weights.safetensors").card["images"] == 3
    assert "alone" in sentence(train(labelled.folder, tmp_path / "other", first))


def test_labels_that_cannot_be_used_stop_with_file_and_place_unless_left_out(
    labelled: Project, tmp_path: Path
) -> None:
    export_coco(labelled, tmp_path / "coco")
    file = tmp_path / "coco" / "instances.json"
    document = json.loads(file.read_text())
    document["annotations"][0]["segmentation"] = [[5.0, 5.0, 9.0, 5.0, 20.0, 5.0]]
    file.write_text(json.dumps(document))
    told = sentence(train(file, tmp_path / "run"))
    assert str(file) in told
    assert "annotation 1" in told
    assert "area" in told
    assert not (tmp_path / "run").exists()
    assert [len(example.caps) for example in labels_at([file], lenient=True).examples] == [1]
    del document["annotations"][0]
    file.write_text(json.dumps(document))
    (tmp_path / "coco" / "images" / "bed_2.jpg").unlink()
    assert "bed_2.jpg" in sentence(train(file, tmp_path / "run"))


def test_a_photo_teaches_as_complete_once_somebody_calls_it_annotated(labelled: Project) -> None:
    labelled.write(lambda connection: set_status(connection, 2, "annotated", user="Ada"))
    labels = labels_of_project(labelled)
    assert [(e.path.name, e.complete) for e in labels.examples] == [("bed_1.jpg", False), ("bed_2.jpg", True)]
    assert [entry.get("complete") for entry in labels.entries] == [False, None]
    assert reasons(labels) == {"without labels": 1}


def test_an_empty_photo_teaches_that_nothing_is_there_if_somebody_says_so(labelled: Project) -> None:
    labelled.write(lambda connection: set_status(connection, 3, "annotated", user="Ada"))
    *_, empty = labels_of_project(labelled).examples
    assert (empty.caps, empty.complete) == ([], True)


def test_photos_that_teach_nothing_are_counted_by_the_reason(labelled: Project) -> None:
    annotate(labelled, 3, uid="unsure", visible=circle(50, 50, 20), doubtful=True)
    assert reasons(labels_of_project(labelled)) == {"without a cap that can be learnt": 1}
    labelled.write(lambda connection: set_status(connection, 2, "approved", user="Ada"))
    assert reasons(labels_of_project(labelled)) == {"not approved, as others are": 2}


def test_a_coco_file_of_others_is_complete_and_one_of_ours_says_which_photos_are(
    labelled: Project, tmp_path: Path
) -> None:
    labelled.write(lambda connection: set_status(connection, 1, "annotated", user="Ada"))
    export_coco(labelled, tmp_path / "coco")
    file = tmp_path / "coco" / "instances.json"
    assert [example.complete for example in labels_at([file]).examples] == [True, False]
    document = json.loads(file.read_text())
    for image in document["images"]:
        del image["status"]
        image.pop("partial", None)
    document["images"].append({"id": 7, "file_name": "bare.jpg"})
    (tmp_path / "coco" / "images" / "bare.jpg").write_bytes((labelled.images / "bed_2.jpg").read_bytes())
    file.write_text(json.dumps(document))
    labels = labels_at([file])
    assert [example.complete for example in labels.examples] == [True, True]
    assert reasons(labels) == {"without labels": 1}


def with_stones(project: Project, folder: Path) -> Path:
    """An export in which one of two labels is called a stone."""
    export_coco(project, folder)
    file = folder / "instances.json"
    document = json.loads(file.read_text())
    document["categories"].append({"id": 99, "name": "Stone"})
    document["annotations"][1]["category_id"] = 99
    for image in document["images"]:
        image.pop("status", None)
        image.pop("partial", None)
    file.write_text(json.dumps(document))
    return file


def test_only_caps_are_taught_where_a_file_has_other_categories(labelled: Project, tmp_path: Path) -> None:
    labels = labels_at([with_stones(labelled, tmp_path / "coco")])
    assert [(len(example.caps), len(example.ignored)) for example in labels.examples] == [(1, 0), (0, 0)]
    assert labels.others == {"Stone": 1}
    assert "Labels that are of no cap: 1 Stone." in str(divided(labels, None, seed=0))


def test_it_can_be_said_which_categories_are_caps(labelled: Project, tmp_path: Path) -> None:
    file = with_stones(labelled, tmp_path / "coco")
    labels = labels_at([file], categories=["stone"])
    assert [len(example.caps) for example in labels.examples] == [0, 1]
    assert labels.others == {"mushroom": 1}
    both = labels_at([file], categories=["stone", "mushroom"])
    assert [len(example.caps) for example in both.examples] == [1, 1]
    assert not both.others


def test_where_nothing_is_called_a_cap_it_must_be_said_what_is(labelled: Project, tmp_path: Path) -> None:
    file = with_stones(labelled, tmp_path / "coco")
    document = json.loads(file.read_text())
    document["categories"] = [{"id": 1, "name": "white"}, {"id": 99, "name": "brown"}]
    file.write_text(json.dumps(document))
    told = sentence(train(file, tmp_path / "run"))
    assert "brown, white" in told
    assert "--categories" in told
    assert not (tmp_path / "run").exists()
    # One category is of caps, whatever it is called.
    document["annotations"][1]["category_id"] = 1
    file.write_text(json.dumps(document))
    assert sum(len(example.caps) for example in labels_at([file]).examples) == 2


def test_every_photo_of_a_project_is_in_the_record_with_its_reason(labelled: Project) -> None:
    labelled.write(lambda connection: set_status(connection, 2, "approved", user="Ada"))
    said = divided(labels_of_project(labelled), None, seed=0).record()
    assert {entry["file_name"][:5]: entry.get("used", entry.get("left_out")) for entry in said} == {
        "bed_1": "not approved, as others are",
        "bed_2": "learnt",
        "bed_3": "without labels",
    }
    assert all(len(entry["sha256"]) == 64 for entry in said)


def test_training_on_a_project_obeys_its_splits_and_says_so(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    annotate(labelled, 3, uid="three", visible=circle(60, 60, 25))
    labelled.write(lambda connection: set_splits(connection, {1: "train", 2: "val", 3: "test"}))
    labelled.write(lambda connection: set_status(connection, 2, "annotated", user="Ada"))
    done = train(labelled.folder, tmp_path / "run", "--config", recipe, "--json")
    assert done.exit_code == 0, done.output
    assert "validates on 1. Left out: 1 kept for tests." in done.stderr
    record = json.loads((tmp_path / "run" / "labels.json").read_bytes())
    used = {each["file_name"][:5]: each.get("used", each.get("left_out")) for each in record["images"]}
    assert used == {"bed_1": "learnt", "bed_2": "validated", "bed_3": "kept for tests"}
