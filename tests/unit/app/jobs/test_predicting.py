"""Predictions of a network: stored image by image, gone on with, and drawn in open tabs as they come."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from typer.testing import CliRunner

from fairyring.app.caps.image_caps import caps_of
from fairyring.app.caps.whole_outlines import derive_edits
from fairyring.app.cli import app
from fairyring.app.jobs.finders import Network, network_of
from fairyring.app.jobs.predicting import predict_images
from fairyring.app.protocol import Cancel, Edits, JobProgress, Notice, Predicted, Select, Show
from fairyring.app.weights import weights_of
from fairyring.model.errors import FairyringError
from fairyring.model.predict.predictor import Predictor
from fairyring.storage.contents import load_annotations, load_contents, load_predictions
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.project import Project
from fairyring.storage.records import Cap, Edit
from tests.support.sighted import write_weights
from tests.support.stored import stored_runs
from tests.support.tab import Tab, new_cap, until


@pytest.fixture(scope="module")
def weights(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("weights") / "small.safetensors"
    write_weights(path)
    return path


@pytest.fixture
def network(weights: Path) -> Network:
    return network_of(weights, device="cpu")


@pytest.fixture
def ids(project: Project) -> list[int]:
    with project.read() as connection:
        return list_ids(connection, ImageFilter())


def fairyring(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def state(project: Project) -> list[object]:
    """Everything the store says of runs and predictions."""
    with project.read() as connection:
        ids = list_ids(connection, ImageFilter())
        return [stored_runs(connection), *(load_predictions(connection, i) for i in ids)]


def test_predict_stores_outlines_scores_and_centres_with_the_weights_that_said_so(
    project: Project, weights: Path, network: Network
) -> None:
    done = fairyring("predict", project.folder, "--weights", weights, "--device", "cpu", "--json")
    assert done.exit_code == 0, done.output
    figures = json.loads(done.stdout)
    with project.read() as connection:
        every = [load_contents(connection, i) for i in list_ids(connection, ImageFilter())]
    assert figures == {
        "images": 3,
        "caps": sum(len(contents.predictions) for contents in every),
        "known": 0,
        "problems": 0,
        "run": network.name,
    }
    for contents in every:
        assert contents.run is not None
        assert (contents.run.kind, contents.run.weights) == ("network", network.digest)
        assert contents.run.settings["least_score"] == 0.3
        assert contents.predictions
        assert all(0.3 <= p.score <= 1 and p.visible for p in contents.predictions)
    told = [p for contents in every for p in contents.predictions if p.whole is not None]
    assert told
    assert all(p.centre == (p.whole.cx, p.whole.cy) for p in told if p.whole)
    assert all(min(p.extra["center_sd"]) > 0 for p in told if "center_sd" in p.extra)


def test_a_cap_that_is_accepted_as_it_is_keeps_the_centre_that_was_predicted(
    project: Project, ids: list[int], tmp_path: Path
) -> None:
    write_weights(tmp_path / "looks_again.safetensors", second_look=16)
    predict_images(project, network_of(tmp_path / "looks_again.safetensors", device="cpu"), ids[:1])
    with project.read() as connection:
        contents = load_contents(connection, ids[0])
    assert len(contents.likely) == len(contents.predictions) > 0
    every = caps_of(contents)
    for said in contents.predictions:
        cap = Cap(visible=said.visible, prediction=said.id)
        edit = Edit(id=f"e{said.id}", annotation=f"a{said.id}", image=ids[0], base=0, cap=cap)
        (derived,) = derive_edits(project, [edit], known=every)
        assert (derived.fit.centre or (0, 0)) == pytest.approx(said.centre or (0, 0), abs=1e-6)


def test_a_run_that_was_stopped_goes_on_where_it_was(
    project: Project, network: Network, ids: list[int]
) -> None:
    def stop(done: int, _total: int, _what: str) -> None:
        if done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        predict_images(project, network, ids, progress=stop)
    after_one = state(project)
    seen: list[int] = []
    outcome = predict_images(project, network, ids, predicted=seen.append)
    assert (outcome.images, outcome.known, seen) == (2, 1, ids[1:])
    assert state(project)[:2] == after_one[:2]
    again = predict_images(project, network, ids)
    assert (again.images, again.known) == (0, 3)
    assert str(again) == "Nothing to do: these weights have seen 3 images before."


def test_ctrl_c_says_what_is_kept_and_how_to_go_on(
    project: Project, weights: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, predicted: Callable[[int], None], **__: object) -> None:
        predicted(1)
        raise KeyboardInterrupt

    monkeypatch.setattr("fairyring.app.jobs.predicting.predict_images", interrupted)
    done = fairyring("predict", project.folder, "--weights", weights)
    assert done.exit_code == 130
    assert "predicted and kept: 1" in done.stderr


def test_other_weights_or_redo_make_a_run_of_their_own_which_is_then_shown(
    project: Project, network: Network, ids: list[int], tmp_path: Path
) -> None:
    predict_images(project, network, ids)
    other = tmp_path / "other.safetensors"
    write_weights(other, seed=1)
    predict_images(project, network_of(other), ids[:1])
    assert predict_images(project, network, ids[:1]).images == 1, "its predictions are no longer shown"
    assert predict_images(project, network, ids[:1], redo=True).images == 1
    with project.read() as connection:
        runs = stored_runs(connection)
        shown = load_contents(connection, ids[0]).run
    assert [run.kind for run in runs] == ["network"] * 4 + ["simulated"]
    assert shown == runs[0]


def test_annotations_are_never_touched(port: int, project: Project, network: Network, ids: list[int]) -> None:
    with Tab(port, image=ids[0]) as tab:
        shown = tab.expect(Show).contents.predictions[0]
        tab.edit(new_cap(ids[0], prediction=shown.id))
    with project.read() as connection:
        before = load_annotations(connection, ids[0])
    predict_images(project, network, ids)
    with project.read() as connection:
        assert load_annotations(connection, ids[0]) == before


def test_what_people_have_labelled_is_not_offered_again_but_still_compared(
    serve: Callable[..., int], project: Project, ids: list[int]
) -> None:
    own = project.folder / "weights" / "own.safetensors"
    write_weights(own)
    # Other settings that see the same, so that the button makes a run of its own.
    predict_images(project, network_of(own, device="cpu", least_score=0.300001), ids[:1])
    with Tab(serve(), image=ids[0]) as tab:
        first = tab.expect(Show).contents.predictions
        accepted = [
            new_cap(ids[0], uid=f"cap-{p.id}", edit=f"e{p.id}", visible=p.visible, prediction=p.id)
            for p in first
        ]
        tab.edit(*accepted)
        tab.panel.set("Predict this image", True)
        assert tab.expect(Predicted).predictions == []
        tab.expect(Notice)
        tab.send(Select(annotations=[accepted[0].annotation]))
        until(lambda: f'title="{accepted[0].annotation}"' in tab.panel.html, "the inspector")
        assert "none matches this cap" not in tab.panel.html
    with project.read() as connection:
        assert load_contents(connection, ids[0]).predictions == []
        again = load_predictions(connection, ids[0])
    assert len(again) == len(first)
    assert {p.run for p in again}.isdisjoint({p.run for p in first})


def test_a_photo_that_cannot_be_read_is_named_and_the_others_are_predicted(
    project: Project, weights: Path
) -> None:
    broken, gone = project.images / "bed_1.jpg", project.images / "bed_2.jpg"
    broken.write_bytes(broken.read_bytes()[:900])
    gone.unlink()
    done = fairyring("predict", project.folder, "--weights", weights)
    assert done.exit_code == 0
    assert str(broken) in done.stderr
    assert str(gone) in done.stderr
    assert "1 image predicted" in done.stderr
    alone = fairyring("predict", project.folder, "--weights", weights, "--images", "bed_1*")
    assert isinstance(alone.exception, FairyringError)
    assert str(broken) in str(alone.exception)


def test_a_pattern_that_names_no_image_says_so(project: Project, weights: Path) -> None:
    done = fairyring("predict", project.folder, "--weights", weights, "--images", "moon_*")
    assert isinstance(done.exception, FairyringError)
    assert "moon_*" in str(done.exception)


@pytest.mark.parametrize("damage", ["cut", "flipped", "text", "missing"])
def test_weights_that_cannot_be_used_change_nothing(
    project: Project, weights: Path, tmp_path: Path, damage: str
) -> None:
    raw = weights.read_bytes()
    bad = tmp_path / "bad.safetensors"
    if damage != "missing":
        flipped = raw[:-100] + bytes([raw[-100] ^ 1]) + raw[-99:]
        bad.write_bytes({"cut": raw[:-1000], "flipped": flipped, "text": b"weights"}[damage])
    before = state(project)
    done = fairyring("predict", project.folder, "--weights", bad)
    assert isinstance(done.exception, FairyringError)
    assert str(bad) in str(done.exception)
    assert state(project) == before


def test_the_projects_newest_weights_are_taken(project: Project, weights: Path) -> None:
    import os
    import shutil

    own = project.folder / "weights"
    own.mkdir()
    for age, name in enumerate(("new", "old")):
        shutil.copyfile(weights, own / f"{name}.safetensors")
        os.utime(own / f"{name}.safetensors", (10**9 - age, 10**9 - age))
    assert weights_of(project) == own / "new.safetensors"


def test_a_button_predicts_the_image_and_draws_it_in_every_tab_that_shows_it(
    serve: Callable[..., int], project: Project, ids: list[int]
) -> None:
    write_weights(project.folder / "weights" / "own.safetensors")
    port = serve()
    with (
        Tab(port, image=ids[0]) as tab,
        Tab(port, name="Ben", image=ids[0]) as same,
        Tab(port, name="Eve", image=ids[1]) as other,
    ):
        shown = tab.expect(Show)
        until(lambda: "own.safetensors" in tab.panel.html, "the name of the weights")
        tab.panel.set("Predict this image", True)
        told = tab.expect(Predicted)
        assert told == same.expect(Predicted)
        assert told.image == ids[0]
        with project.read() as connection:
            contents = load_contents(connection, ids[0])
        assert told.predictions == contents.predictions != shown.contents.predictions
        sentence = tab.expect(Notice).text
        assert re.search(rf"own \w+: 1 image predicted, {len(told.predictions)} caps? seen\.", sentence)
        # A prediction that was just drawn can be accepted at once.
        accepted = new_cap(ids[0], prediction=told.predictions[0].id)
        tab.send(Edits(edits=[accepted]))
        assert other.nothing_more(Predicted)


def test_a_button_predicts_every_image_until_it_is_cancelled(
    serve: Callable[..., int], project: Project, ids: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    write_weights(project.folder / "weights" / "own.safetensors")
    read = Predictor.read

    def slowly(self: Predictor, seen: Any) -> Any:
        # Progress is drawn twice a second, and such small photos would be done before.
        time.sleep(1.5)
        return read(self, seen)

    monkeypatch.setattr(Predictor, "read", slowly)
    with Tab(serve(), image=ids[2]) as tab:
        tab.expect(Show)
        tab.panel.set("Predict every image", True)
        working = tab.expect(JobProgress, lambda each: "Predicting bed_2" in each.words)
        tab.send(Cancel(job=working.job))
        assert "Cancelled" in tab.expect(Notice).text
    with project.read() as connection:
        runs = {i: load_contents(connection, i).run for i in ids}
    kinds = [run.kind if run else None for run in runs.values()]
    assert kinds[0] == "network"
    assert kinds[2] is None


def test_a_project_is_served_and_help_is_shown_without_torch() -> None:
    script = "import sys, app.cli, app.gateway.server; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_without_weights_the_panel_says_what_to_do(
    serve: Callable[..., int], project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fairyring.app.weights.SHIPPED", project.folder / "none.safetensors")
    with Tab(serve(), image=1) as tab:
        until(lambda: "No weights to predict with" in tab.panel.html, "what to do")
        assert str(project.folder / "weights") in tab.panel.html
