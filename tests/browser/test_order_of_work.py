"""Images in the order in which a look is worth most, chosen in the page and walked through."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from tests.support.plain_bed import ring

SCORES = {
    "a.png": ("top", [0.9, 0.9]),
    "b.png": ("top", [0.3, 0.4, 0.5]),
    "c.png": ("side", [0.8]),
    "d.png": ("side", [0.35, 0.9, 0.95]),
    "e.png": ("top", [0.6, 0.6]),
}
"""Light and scores: b leaves 1.8 caps to be wrong, d and e .8, a and c .2."""
IN_TURN = ["b.png", "d.png", "e.png", "c.png", "a.png"]
"""Of top light b, e, a, of side light d, c; the first of each, the second of each, …; the most at first."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    images, said = [], []
    for number, (name, (light, scores)) in enumerate(SCORES.items(), start=1):
        cv2.imwrite(str(tmp_path / name), np.full((200, 400, 3), 30 * number, np.uint8))
        images.append({"id": number, "file_name": name, "width": 400, "height": 200, "light": light})
        for k, score in enumerate(scores):
            outline = ring(80 + 110 * k, 100, 40)
            cap = {"image_id": number, "category_id": 1, "segmentation": [outline], "score": score}
            said.append(cap | {"id": len(said) + 1})
    document = {"images": images, "annotations": said, "categories": [{"id": 1, "name": "mushroom"}]}
    (tmp_path / "said.json").write_text(json.dumps(document))
    with create_project(tmp_path / "beds") as made:
        import_paths(made, [tmp_path / "said.json"], as_=ImportAs.predictions, strict=True)
    return tmp_path / "beds"


def listed(tab: Tab) -> list[str]:
    texts = tab.page.locator("[data-fairyring-open]").all_inner_texts()
    return [name for text in texts for name in SCORES if name in text]


def test_images_come_in_the_order_of_what_is_to_gain(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.page.get_by_role("tab", name="Images", exact=True).click()
    tab.page.get_by_text("Filter and order").click()
    tab.page.get_by_role("combobox", name="Order").click()
    tab.page.get_by_role("option", name="most to gain first").click()
    tab.page.wait_for_function(
        "name => document.querySelector('[data-fairyring-open]')?.textContent.includes(name)",
        arg=IN_TURN[0],
    )
    assert listed(tab) == IN_TURN
    tab.open(IN_TURN[0])
    walked = [IN_TURN[0]]
    for name in IN_TURN[1:]:
        tab.press("n")
        tab.wait_for(f"window.fairyring.state.image.file_name !== {walked[-1]!r}")
        walked.append(tab.state("image.file_name"))
        assert walked[-1] == name
    # What is done goes behind all that is not, and leads on from where it was.
    tab.open("d.png")
    tab.accept_all()
    tab.saved()
    tab.press("Control+Enter")
    tab.wait_for("window.fairyring.state.image.file_name === 'e.png'")
    tab.page.wait_for_function(
        "() => [...document.querySelectorAll('[data-fairyring-open]')].at(-1)?.textContent.includes('d.png')"
    )
    assert listed(tab) == ["b.png", "c.png", "e.png", "a.png", "d.png"]
