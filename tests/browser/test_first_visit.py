"""Somebody comes to an empty project, drops photos, and has the network look at one."""

from __future__ import annotations

import base64
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.project import create_project, open_project
from tests.support.sighted import write_weights


@pytest.fixture
def project(tmp_path: Path) -> Path:
    create_project(tmp_path / "beds").close()
    write_weights(tmp_path / "beds" / "weights" / "own.safetensors")
    return tmp_path / "beds"


DROP = """(files) => {
  const data = new DataTransfer();
  for (const [name, text] of files) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    data.items.add(new File([bytes], name));
  }
  const target = document.getElementById('fairyring-editor');
  for (const type of ['dragover', 'drop'])
    target.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
}"""


def test_photos_are_dropped_onto_an_empty_project_and_predicted(
    browser: Browser, server: Server, project: Path
) -> None:
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    context.add_cookies([{"name": "fairyring_name", "value": "Ada", "url": server.url}])
    tab = Tab(context.new_page())
    tab.page.goto(server.url)
    tab.page.get_by_text("No photos yet").wait_for()
    tab.page.locator(".fr-cap code").get_by_text("fairyring import").wait_for()

    noise = np.random.default_rng(1).integers(0, 255, (240, 320, 3), dtype=np.uint8)
    photo = base64.b64encode(cv2.imencode(".png", noise)[1].tobytes()).decode()
    tab.page.evaluate(DROP, [["bed 1.png", photo], ["notes.txt", base64.b64encode(b"no photo").decode()]])
    tab.wait_for("window.fairyring.state.image?.file_name === 'bed 1.png'")
    tab.page.get_by_text("1 photo taken in").wait_for()
    tab.page.locator(".fairyring-notice.is-error").filter(has_text="notes.txt").wait_for()
    with open_project(project) as opened, opened.read() as connection:
        rows = list_images(connection, ImageFilter()).rows
    assert [(row.image.file_name, row.image.width) for row in rows] == [("bed 1.png", 320)]
    assert not list((project / "cache" / "uploads").iterdir())

    tab.page.locator(".fr-cap").get_by_role("button", name="Predict this image").click()
    tab.wait_for("window.fairyring.state.predictions.length > 0")
    context.close()
