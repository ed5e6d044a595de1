"""The wheel, built and installed into an environment of its own, away from the checkout."""

from __future__ import annotations

import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--outdir", out, TOP], check=True, capture_output=True
    )
    return next(out.glob("*.whl"))


def test_the_wheel_carries_the_editor_the_weights_and_the_migrations(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert "fairyring/static/editor/main.js" in names
    assert {f"fairyring/model/weights/{file.name}" for file in (TOP / "model" / "weights").iterdir()} <= names
    assert any(name.startswith("fairyring/storage/migrations/versions/") for name in names)
    assert not any(name.startswith(("app/", "model/", "storage/", "static/", "tests/")) for name in names)


def test_the_installed_wheel_makes_imports_and_exports_a_project(wheel: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "env", with_pip=True)
    python = tmp_path / "env" / "bin" / "python"
    # A path file lends this environment's dependencies: only Fairyring itself is installed afresh.
    here = next(p for p in sys.path if p.endswith("site-packages"))
    there = next((tmp_path / "env" / "lib").glob("python*/site-packages"))
    (there / "dependencies.pth").write_text(f"import sys; sys.path.append({here!r})\n")
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-deps", wheel], check=True, cwd=tmp_path)

    def fairyring(*words: str) -> subprocess.CompletedProcess[str]:
        command = [tmp_path / "env" / "bin" / "fairyring", *words]
        return subprocess.run(command, check=True, cwd=tmp_path, capture_output=True, text=True)

    where = subprocess.check_output(
        [python, "-c", "import fairyring.app; print(fairyring.app.__file__)"], cwd=tmp_path, text=True
    )
    assert str(tmp_path) in where
    fairyring("demo", "beds", "--count", "1")
    fairyring("export", "beds", "out", "--only", "predicted")
    assert (tmp_path / "out" / "instances.json").exists()
