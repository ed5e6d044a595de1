"""A training from its first step to its weights: what it records, how it stops and how it goes on."""

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

from fairyring.model.network.weights import load_weights
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from tests.support.sighted import RECIPE, SMALL
from tests.support.stored import stored_runs
from tests.support.tab import until
from tests.support.terminal import fairyring, sentence, train
from tests.unit.app.conftest import circle
from tests.unit.app.jobs.conftest import annotate


def test_what_was_trained_on_a_project_predicts_and_is_traced_to_the_revisions_it_saw(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    done = train(labelled.folder, out, "--config", recipe, "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    photos = told.pop("photos")
    assert told == {"weights": str(out / "weights.safetensors"), "validation": {}}
    assert (photos["complete"], photos["partial"], photos["caps_of_partial"]) == (0, 2, 2)
    assert "Learns from 2 partly labelled photos (2 caps" in done.stderr

    record = json.loads((out / "labels.json").read_bytes())
    assert record["images_are"] == "annotated"
    assert [(e["file_name"], e["caps"]) for e in record["images"] if e.get("used") == "learnt"] == [
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
        assert stored_runs(connection)[0].weights == weights.digest


@pytest.mark.parametrize("to_all", [False, True])
def test_a_training_that_is_terminated_keeps_what_it_has_and_says_how_to_go_on(
    labelled: Project, recipe: Path, tmp_path: Path, to_all: bool
) -> None:
    recipe.write_text(RECIPE.replace("iterations = 3", "iterations = 5000"))
    out = tmp_path / "run"
    fairyring = [sys.executable, "-c", "from fairyring.app.cli import main; main()"]
    command = [*fairyring, "train", str(labelled.folder)]
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


def test_a_run_that_was_stopped_goes_on_to_the_same_weights_and_to_no_others(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Sums depend in their last bit on how many threads share them, which other tests may have changed.
    torch.set_num_threads(1)
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    assert train(labelled.folder, whole, "--config", recipe).exit_code == 0
    with monkeypatch.context() as patched:
        patched.setattr("fairyring.app.commands.train.shown_on_stderr", stopping_after(2))
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
    from fairyring.storage.records import Edit

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
