"""Addresses that change whenever a file does, and which modules a page will need."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from fairyring.app.gateway import static_files as served
from fairyring.app.gateway.static_files import StaticFiles, files_of, static_files, version_of


@pytest.fixture
def static(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.css").write_text("a")
    (tmp_path / "sub" / "b.js").write_text("b")
    monkeypatch.setattr(served, "STATIC", tmp_path)
    return tmp_path


@pytest.mark.usefixtures("static")
def test_every_file_below_static_is_found() -> None:
    assert static_files().contents == {"a.css": b"a", "sub/b.js": b"b"}
    assert static_files().url("sub/b.js") == f"/static/{static_files().version}/sub/b.js"
    assert static_files() is static_files()


def test_a_change_is_seen_at_once_and_changes_every_address(static: Path) -> None:
    before = static_files()
    (static / "a.css").write_text("A")
    os.utime(static / "a.css", ns=(1, 1))
    after = static_files()
    assert after.contents["a.css"] == b"A"
    assert after.url("sub/b.js") != before.url("sub/b.js")


def test_the_files_of_a_page_come_without_a_look_at_the_disk_until_a_page_has_a_newer_version(
    static: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = static_files()
    (static / "a.css").write_text("longer")
    with monkeypatch.context() as away:
        away.setattr(served, "STATIC", None)
        assert files_of(before.version) is before
    assert files_of("of an older page").contents["a.css"] == b"longer"
    assert files_of(before.version).contents["a.css"] == b"longer"


def test_the_version_tells_names_and_contents_apart() -> None:
    versions = [
        version_of(contents)
        for contents in ({"a": b"b"}, {"b": b"a"}, {"a": b"", "b": b""}, {"a": b"b", "b": b""}, {})
    ]
    assert len(set(versions)) == 5


def test_imports_are_followed_but_not_types_workers_or_loads_on_demand() -> None:
    modules = {
        "editor/main.js": 'import { a,\n  b } from "./room/a.js";\n'
        'import "./bare.js";\nexport * from "./c.js";\n',
        "editor/room/a.js": 'import { c } from "../c.js";\n/** @typedef {import("./types.js").T} T */\n'
        'const later = () => import("./later.js");\nnew Worker(new URL("./worker.js", import.meta.url));\n',
        "editor/bare.js": 'import { main } from "./main.js";\n',
        "editor/c.js": 'import { gone } from "./gone.js";\n',
        "editor/room/types.js": "",
        "editor/room/later.js": "",
        "editor/room/worker.js": "",
    }
    files = StaticFiles({name: text.encode() for name, text in modules.items()}, version="1")
    assert files.imported_by("editor/main.js") == ["editor/room/a.js", "editor/bare.js", "editor/c.js"]


def test_nothing_is_left_out_of_the_editors_own_modules() -> None:
    files = static_files()
    found = files.imported_by("editor/main.js")
    assert len(found) == len(set(found)) > 30
    assert set(found) <= files.contents.keys()
