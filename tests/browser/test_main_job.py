"""The whole job: import a COCO file, correct it in the browser, cut the power, export, take it elsewhere."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import faster_coco_eval
import pytest
from pycocotools.coco import COCO
from typer.testing import CliRunner

from fairyring.app.bench.browser.tab import Tab, centroid
from fairyring.app.cli import app
from fairyring.model.scene.dataset import write_beds
from fairyring.model.scene.presets import preset
from tests.support.forked import forked_server


def fairyring(*words: str | Path) -> str:
    done = CliRunner().invoke(app, [str(word) for word in words])
    assert done.exit_code == 0, done.output
    return done.output


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("beds") / "out"
    write_beds(out, preset("default"), count=2, seed=3)
    return out


@pytest.fixture
def imported(beds: Path, tmp_path: Path) -> Path:
    fairyring("init", tmp_path / "project")
    fairyring("import", tmp_path / "project", beds / "images", beds / "instances.json")
    return tmp_path / "project"


def test_corrected_labels_survive_a_power_cut_and_load_elsewhere(
    imported: Path, open_tab: Callable[..., Tab], tmp_path: Path
) -> None:
    server = forked_server(imported)
    server.start()
    tab = open_tab(server)
    before = tab.state("shapes")
    wrong, moved, marked = pick_three(before)
    delete(tab, wrong)
    nudge(tab, moved)
    mark_with_circle(tab, marked, radius=22.0)
    draw_missed_cap(tab)
    tab.press("Escape", "Control+z", "Control+Shift+z")
    tab.saved()
    expected = {shape["uid"]: shape["cap"] for shape in tab.state("shapes")}
    server.kill()

    server.start()
    again = open_tab(server)
    assert {shape["uid"]: shape["cap"] for shape in again.state("shapes")} == expected
    assert len(expected) == len(before)
    server.stop()

    fairyring("export", imported, tmp_path / "out")
    document = json.loads((tmp_path / "out" / "instances.json").read_text())
    with redirect_stdout(StringIO()):
        loaded, faster = (
            COCO(tmp_path / "out" / "instances.json"),
            faster_coco_eval.COCO(tmp_path / "out" / "instances.json"),
        )
    first = document["images"][0]["id"]
    assert len(loaded.getAnnIds(imgIds=[first])) == len(faster.getAnnIds(imgIds=[first])) == len(expected)
    for annotation in loaded.loadAnns(loaded.getAnnIds()):
        assert loaded.annToMask(annotation).any()
    circles = [a for a in document["annotations"] if a.get("circle")]
    assert any(a["circle"][2] == pytest.approx(22.0, abs=1.0) for a in circles)

    fairyring("init", tmp_path / "second")
    fairyring("import", tmp_path / "second", tmp_path / "out" / "instances.json", "--strict")
    fairyring("export", tmp_path / "second", tmp_path / "out2")
    returned = json.loads((tmp_path / "out2" / "instances.json").read_text())
    assert len(returned["annotations"]) == len(document["annotations"])
    for one, other in zip(document["annotations"], returned["annotations"], strict=True):
        assert flat(one) == pytest.approx(flat(other), abs=0.01)


def pick_three(shapes: list[dict]) -> list[dict]:
    """Caps well inside the photo and far from each other."""
    chosen: list[dict] = []
    for shape in sorted(shapes, key=lambda s: -len(s["cap"]["visible"][0])):
        x, y = centroid(shape["cap"]["visible"][0])
        others = [centroid(other["cap"]["visible"][0]) for other in chosen]
        if 200 < x < 1080 and 150 < y < 570 and all(abs(x - a) + abs(y - b) > 250 for a, b in others):
            chosen.append(shape)
    return chosen[:3]


def delete(tab: Tab, shape: dict) -> None:
    tab.press("Escape", "v")
    assert tab.select(centroid(shape["cap"]["visible"][0])) == shape["uid"]
    tab.press("Delete")
    tab.wait_for(f"!window.fairyring.state.shapes.some((s) => s.uid === {shape['uid']!r})")


def nudge(tab: Tab, shape: dict) -> None:
    tab.press("Escape", "v")
    tab.select(centroid(shape["cap"]["visible"][0]))
    tab.press("Shift+ArrowRight", "ArrowDown")
    tab.saved()


def mark_with_circle(tab: Tab, shape: dict, *, radius: float) -> None:
    x, y = centroid(shape["cap"]["visible"][0])
    tab.press("Escape", "v")
    tab.select((x, y))
    tab.press("c")
    tab.drag((x, y), (x + radius, y))
    tab.saved()


def draw_missed_cap(tab: Tab) -> None:
    tab.press("Escape", "w")
    for corner in [(3.0, 3.0), (24.0, 4.0), (26.0, 22.0), (5.0, 25.0)]:
        tab.click(corner)
    tab.press("Enter")
    tab.saved()


def flat(annotation: dict) -> list[float]:
    numbers = [value for part in annotation["segmentation"] for value in part]
    return numbers + list(annotation["center"]) + list(annotation.get("circle") or annotation["ellipse"])
