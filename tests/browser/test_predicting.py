"""Somebody asks for predictions in the panel, sees them come, and stops what takes too long."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server, served
from fairyring.app.cli import app
from fairyring.storage.contents import load_contents
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project, open_project
from tests.support.sighted import write_weights

PHOTOS = 12


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Small photos of noise, no predictions, and weights that see caps in them."""
    photos, generator = tmp_path / "photos", np.random.default_rng(1)
    photos.mkdir()
    for number in range(PHOTOS):
        noise = generator.integers(0, 255, (240, 320, 3), dtype=np.uint8)
        cv2.imwrite(str(photos / f"bed_{number}.png"), noise)
    with create_project(tmp_path / "beds") as made:
        import_paths(made, [photos])
    write_weights(tmp_path / "beds" / "weights" / "own.safetensors")
    return tmp_path / "beds"


@pytest.fixture
def server(project: Path) -> Iterator[Server]:
    with served(project) as running:
        yield running


def test_predictions_are_drawn_as_they_come_and_the_rest_can_be_cancelled(
    project: Path, server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    assert tab.state("predictions") == []
    tab.page.get_by_role("tab", name="Jobs").click()
    tab.page.get_by_text("the newest in the project's weights folder").wait_for()

    tab.page.get_by_role("button", name="Predict this image").last.click()
    tab.wait_for("window.fairyring.state.predictions.length > 0")
    tab.page.get_by_text("1 image predicted").first.wait_for()
    tab.accept_all()
    tab.saved()
    accepted = tab.state("shapes")
    assert accepted
    assert all(shape["cap"]["prediction"] for shape in accepted)

    tab.page.get_by_role("button", name=re.compile(r"Predict every image: 11 images, about \d+ s")).click()
    tab.page.locator(".fr-header progress[max]").wait_for()
    tab.page.get_by_text(re.compile(r"of 11 · about .* left · Predicting bed_")).first.wait_for()
    tab.press("n")
    tab.wait_for("window.fairyring.state.image.file_name === 'bed_1.png'")
    tab.wait_for("window.fairyring.state.predictions.length > 0")
    tab.page.locator(".fr-header").get_by_role("button", name="Cancel").click()
    tab.page.get_by_text("what was done so far is kept").first.wait_for()
    with open_project(project) as opened, opened.read() as connection:
        every = [load_contents(connection, i) for i in list_ids(connection, ImageFilter())]
    predicted = [contents for contents in every if contents.run is not None]
    assert 2 <= len(predicted) < PHOTOS
    assert {contents.run.id for contents in predicted if contents.run} == {1}
    assert len(every[0].annotations) == len(accepted)


def test_what_was_accepted_is_not_offered_again_by_a_later_run(
    project: Path, server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    tab.page.get_by_role("tab", name="Jobs").click()
    tab.page.get_by_role("button", name="Predict this image").last.click()
    tab.wait_for("window.fairyring.state.predictions.length > 0")
    seen = tab.state("predictions")
    tab.accept_all()
    tab.saved()
    tab.page.get_by_text("1 image predicted").first.wait_for()

    done = CliRunner().invoke(app, ["predict", str(project), "--images", "bed_0.png", "--redo"])
    assert f"{len(seen)} caps seen" in done.stderr
    tab.reload()
    assert tab.state("predictions") == []
    tab.accept_all()
    tab.saved()
    assert len(tab.state("shapes")) == len(seen)
