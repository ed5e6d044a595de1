"""Answers compressed as the browser asks."""

from __future__ import annotations

import gzip

import httpx
import pytest
import zstandard

from fairyring.app.gateway.compressed import encoding_for
from fairyring.app.gateway.static_files import static_files
from fairyring.app.gateway.viser_client import load_viser


@pytest.mark.parametrize(
    ("accepted", "encoding"),
    [
        ("gzip, deflate, br, zstd", "zstd"),
        ("gzip, deflate, br", "gzip"),
        ("GZIP;q=0.5", "gzip"),
        ("zstd;q=0, gzip", "gzip"),
        ("zstd; q=0.000", None),
        ("identity", None),
        ("", None),
    ],
)
def test_the_smallest_of_the_encodings_accepted_is_taken(accepted: str, encoding: str | None) -> None:
    assert encoding_for(accepted) == encoding


@pytest.mark.parametrize(
    ("encoding", "decode"), [("zstd", zstandard.decompress), ("gzip", gzip.decompress), ("identity", bytes)]
)
def test_a_file_arrives_as_it_is_and_says_how_it_was_sent(
    shared_port: int, encoding: str, decode: object
) -> None:
    files = static_files()
    address = f"http://127.0.0.1:{shared_port}{files.url('editor/editor.js')}"
    with httpx.stream("GET", address, headers={"Accept-Encoding": encoding}) as answer:
        sent = b"".join(answer.iter_raw())
    assert answer.headers.get("content-encoding", "identity") == encoding
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["content-type"].startswith("text/javascript")
    assert decode(sent) == files.contents["editor/editor.js"]


def test_visers_client_is_sent_in_less_than_a_third_of_its_size(shared_port: int) -> None:
    client = load_viser()
    sent = {}
    for encoding in ("zstd", "gzip"):
        address = f"http://127.0.0.1:{shared_port}{client.url('client.js')}"
        with httpx.stream("GET", address, headers={"Accept-Encoding": encoding}) as answer:
            sent[encoding] = sum(map(len, answer.iter_raw()))
    assert sent["zstd"] < 660_000
    assert sent["gzip"] < len(client.files["client.js"]) / 3
