"""Which labels are learnt, from a project or from COCO files, and what is kept to check on."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path

import pytest

from fairyring.app.jobs.training_labels import divided, labels_at, labels_of_project
from fairyring.model.geometry.shapes import Circle
from fairyring.model.network.weights import load_weights
from fairyring.storage.exporting import export_coco
from fairyring.storage.project import Project
from fairyring.storage.statuses import set_status
from tests.support.terminal import sentence, train
from tests.unit.app.conftest import circle
from tests.unit.app.jobs.conftest import annotate


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
    assert [len(example.caps) for example in labels_at([file], lenient=True).examples] == [0, 1]
    del document["annotations"][0]
    file.write_text(json.dumps(document))
    (tmp_path / "coco" / "images" / "bed_2.jpg").unlink()
    assert "bed_2.jpg" in sentence(train(file, tmp_path / "run"))


@pytest.mark.parametrize(
    ("splits", "learnt", "checked"),
    [
        ([None] * 3, 3, 0),
        ([None] * 10, 7, 3),
        (["train"] * 5 + ["val"] * 2 + ["test"], 5, 2),
        ([None] * 4 + ["test"] * 6, 3, 1),
    ],
)
def test_images_are_divided_by_their_split_else_seven_to_three(
    labelled: Project, splits: list[str | None], learnt: int, checked: int
) -> None:
    import dataclasses

    some = labels_of_project(labelled)
    examples = [
        dataclasses.replace(some.examples[0], path=Path(f"{number}.jpg")) for number in range(len(splits))
    ]
    labels = dataclasses.replace(some, examples=examples, splits=splits)
    train_side, val_side = divided(labels, None, seed=0)
    assert (len(train_side), len(val_side)) == (learnt, checked)
    assert not {e.path for e in train_side} & {e.path for e in val_side}
    alone, given = divided(labels, some, seed=0)
    assert given == some.examples
    assert len(alone) == sum(split in (None, "train") for split in splits)
