"""`fairyring synth` from the outside: what it writes, our own import of it, and wrong use."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.model.scene.settings import SceneError

SMALL = """
width = 320
height = 200
[growth]
caps = [20, 25]
diameters = [12, 18, 30, 50, 70]
"""


def run(*arguments: str | Path) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("synth")
    (folder / "small.toml").write_text(SMALL)
    out = folder / "beds"
    run("synth", out, "--count", "2", "--light", "side", "--form", "d", "--config", folder / "small.toml")
    return out


def test_the_options_reach_the_beds(beds: Path) -> None:
    document = json.loads((beds / "instances.json").read_text())
    assert [(image["light"], image["form"]) for image in document["images"]] == [("side", "d")] * 2
    assert [(image["width"], image["height"]) for image in document["images"]] == [(320, 200)] * 2


def test_our_own_import_takes_all_of_it_and_gives_the_same_centres_back(beds: Path, tmp_path: Path) -> None:
    project, exported = tmp_path / "project", tmp_path / "exported"
    run("init", project)
    told = json.loads(run("import", project, beds / "instances.json", "--json"))
    document = json.loads((beds / "instances.json").read_text())
    assert (told["images"], told["problems"]) == (2, 0)
    assert told["annotations"] == len(document["annotations"])
    run("export", project, exported, "--format", "coco")
    again = json.loads((exported / "instances.json").read_text())
    assert {image["light"] for image in again["images"]} == {"side"}
    for before, after in zip(document["annotations"], again["annotations"], strict=True):
        assert after["center"] == pytest.approx(before["center"], abs=0.01)
        assert after["ellipse"] == pytest.approx(before["ellipse"], abs=0.01)
        assert after["order"] == before["order"]
        assert after["area"] == pytest.approx(before["area"], abs=0.5)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--preset", "plot"], "no preset 'plot'"),
        (["--form", "z"], "forms"),
        (["--config", "absent.toml"], "absent.toml cannot be read"),
    ],
)
def test_wrong_settings_get_a_sentence(arguments: list[str], words: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=words):
        run("synth", tmp_path / "out", *arguments)
    assert not (tmp_path / "out").exists()


def test_an_unknown_light_is_wrong_use(tmp_path: Path) -> None:
    assert CliRunner().invoke(app, ["synth", str(tmp_path / "out"), "--light", "sun"]).exit_code == 2
