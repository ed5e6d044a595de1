"""Somebody lets the network learn from corrections, uses what was learnt, and goes back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.project import open_project
from fairyring.storage.statuses import set_status
from tests.support.plain_bed import make_bed, ring
from tests.support.sighted import write_weights


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Four photos of which somebody says that all caps are labelled, and weights that see caps anywhere."""
    made = make_bed(tmp_path, [[ring(150, 150, 50), ring(350, 200, 60)]] * 4)
    write_weights(made / "weights" / "own.safetensors")
    with open_project(made) as opened:
        for image in list_ids_of(opened):
            opened.write(lambda connection, i=image: set_status(connection, i, "approved", user="Ada"))
    return made


def list_ids_of(opened: object) -> list[int]:
    with opened.read() as connection:
        return list_ids(connection, ImageFilter())


def test_learning_shows_before_and_after_and_can_be_taken_back(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    page = tab.page
    page.get_by_role("tab", name="Jobs").click()
    page.get_by_label("Steps").fill("3")
    page.get_by_label("Steps").press("Enter")
    page.get_by_role("button", name="Learn from my corrections").click()
    page.locator(".fr-header .fr-job").wait_for()
    page.get_by_text("corrections-1, from own").wait_for(timeout=120_000)
    row = page.locator(".fr-jobs tr").filter(has=page.locator("th", has_text="AP50"))
    before, after, change = row.locator("td").all_inner_texts()
    assert float(after) - float(before) == pytest.approx(float(change.split()[1]), abs=0.11)

    used = project / "weights" / "corrections-1.safetensors"
    assert not used.exists()
    page.get_by_role("button", name="Use these weights").click()
    page.get_by_text("Weights: corrections-1.safetensors").wait_for()
    assert used.exists()
    page.get_by_role("button", name="Go back").click()
    page.get_by_text("Weights: own.safetensors").wait_for()
    assert not used.exists()
