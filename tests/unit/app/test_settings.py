"""Defaults < file < environment < options."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.app.settings import Settings, SettingsError, load_settings


def test_each_source_overrides_the_one_before(tmp_path: Path) -> None:
    assert load_settings(tmp_path, environment={}) == Settings(host="127.0.0.1", port=8080)
    (tmp_path / "fairyring.toml").write_text("[serve]\nport = 1\nphoto_cache_mb = 5\n[project]\nname = 'x'\n")
    assert load_settings(tmp_path, environment={}).port == 1
    environment = {"FAIRYRING_PORT": "2", "FAIRYRING_OTHER": "x", "PORT": "9"}
    assert load_settings(tmp_path, environment=environment).port == 2
    settings = load_settings(tmp_path, environment=environment, port=3, host=None)
    assert settings == Settings(port=3, photo_cache_mb=5)


def test_another_file_can_stand_in_for_the_projects(tmp_path: Path) -> None:
    (tmp_path / "other.toml").write_text("[serve]\nport = 7\n")
    assert load_settings(tmp_path, file=tmp_path / "other.toml", environment={}).port == 7
    with pytest.raises(SettingsError, match=r"missing\.toml does not exist"):
        load_settings(tmp_path, file=tmp_path / "missing.toml", environment={})


@pytest.mark.parametrize("line", ["prot = 1", "port = 'many'", "port = [1]", "port = ]", "serve = 3"])
def test_a_mistake_names_the_file(tmp_path: Path, line: str) -> None:
    (tmp_path / "fairyring.toml").write_text(line if line.startswith("serve") else f"[serve]\n{line}\n")
    with pytest.raises(SettingsError, match=r"fairyring\.toml"):
        load_settings(tmp_path, environment={})


def test_a_mistake_in_the_environment_says_so() -> None:
    with pytest.raises(SettingsError, match="FAIRYRING_PORT"):
        load_settings(Path("nowhere"), environment={"FAIRYRING_PORT": "http"})
