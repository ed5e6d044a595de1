"""viser's client, taken apart."""

from __future__ import annotations

from pathlib import Path

import pytest
import viser

from fairyring.app.gateway.viser_client import from_base88, load_viser
from fairyring.model.errors import FairyringError


def test_the_parts_are_a_module_styles_and_a_decoder() -> None:
    files = load_viser().files
    assert len(files["client.js"]) > 2_000_000
    assert b"__viserZstdWasm" in files["client.js"]
    assert files["client.css"].decode().count("{") == files["client.css"].decode().count("}") > 100
    assert files["zstd.wasm"].startswith(b"\0asm")
    assert b"__viserZstdWasm" in files["start.js"]


def test_what_is_left_is_a_page_without_scripts() -> None:
    client = load_viser()
    assert "<script" not in client.before + client.after
    assert len(client.before + client.after) < 10_000


@pytest.mark.parametrize(
    ("digits", "number"),
    [("!!!!!", b"\0\0\0\0"), ("!!!!#", b"\0\0\0\1"), ("!!!#!", b"\0\0\0\x58"), ("!#", b"\1"), ("", b"")],
)
def test_base_88_is_read_most_significant_digit_first(digits: str, number: bytes) -> None:
    assert from_base88(digits) == number


def test_another_page_than_expected_is_refused_with_the_remedy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "client" / "build").mkdir(parents=True)
    (tmp_path / "client" / "build" / "index.html").write_text("<html><head></head></html>")
    monkeypatch.setattr(viser, "__file__", str(tmp_path / "__init__.py"))
    load_viser.cache_clear()
    with pytest.raises(FairyringError, match=r"install viser==1\.1\.1 again"):
        load_viser()
    monkeypatch.undo()
    load_viser.cache_clear()
