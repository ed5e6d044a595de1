"""Files as they come: zipped, marked, in other encodings, with what JSON forbids, and what is no document."""

from __future__ import annotations

import gzip
import json
import math
from pathlib import Path
from typing import Any

import pytest

from fairyring.model.coco.document import (
    annotations_by_image,
    document_of,
    objects_of,
    parse_document,
    read_document,
    value_of,
)
from fairyring.model.coco.faults import Fault
from fairyring.model.errors import FairyringError, FileError

DOCUMENT = {
    "info": {"year": 2024},
    "images": [{"id": 1}],
    "annotations": [{"id": 5, "image_id": 1, "note": "Ä"}, {"id": 6, "image_id": "1.0"}, 7],
}
TEXT = json.dumps(DOCUMENT, ensure_ascii=False)


def values_of(data: bytes) -> list[Any]:
    return [value_of(item) for item in parse_document(data).annotations]


@pytest.mark.parametrize(
    "data",
    [
        TEXT.encode(),
        TEXT.encode("utf-8-sig"),
        TEXT.encode("utf-16"),
        TEXT.encode("utf-32"),
        gzip.compress(TEXT.encode()),
        gzip.compress(TEXT.encode("utf-8-sig")),
        gzip.compress(TEXT[:40].encode()) + gzip.compress(TEXT[40:].encode()),
        f" \n{TEXT}\n".encode(),
    ],
    ids=["plain", "marked", "UTF-16", "UTF-32", "gzip", "marked gzip", "two gzips", "white space"],
)
def test_a_document_is_read_however_it_was_saved(data: bytes) -> None:
    document = parse_document(data)
    assert [value_of(item) for item in document.annotations] == DOCUMENT["annotations"]
    assert document.images is not None
    assert [value_of(item) for item in document.images] == DOCUMENT["images"]
    assert document.others == {"info": {"year": 2024}}


def test_a_list_is_a_list_of_results() -> None:
    document = parse_document(b'[{"image_id": 3}]')
    assert (document.images, [value_of(item) for item in document.annotations]) == (None, [{"image_id": 3}])


def test_what_json_forbids_comes_through_for_the_item_that_holds_it() -> None:
    text = '{"images": [], "annotations": [[NaN, -Infinity, 1e999, DIGITS, -DIGITS], "\\ud800", 1]}'
    odd, half, one = values_of(text.replace("DIGITS", "9" * 5000).encode())
    assert math.isnan(odd[0])
    assert odd[1:] == [-math.inf, math.inf, math.inf, -math.inf]
    assert (half, one) == ("\ud800", 1)


def test_a_number_that_no_float_holds_costs_one_item_alone() -> None:
    faults: list[Fault] = []
    data = b'{"images": [], "annotations": [{"id": 1, "x": 1e999}, {"id": "\xff"}, {"id": 3}, 4]}'
    document = parse_document(data)
    found = list(objects_of("annotation", document.annotations, report=faults.append))
    assert [(index, where) for index, where, _ in found] == [(0, "annotation 1"), (2, "annotation 3")]
    assert found[0][2]["x"] == math.inf
    assert [fault.where for fault in faults] == ["annotation at place 2", "annotation at place 4"]


def test_annotations_are_grouped_by_the_value_of_their_image_s_id() -> None:
    items = [{"image_id": one} for one in (1, 1.0, "1", "1.0", "bed", True, None, [1], 1.5)]
    expected = {1: [0, 1, 2, 3], "bed": [4], None: [5, 6, 7, 8, 9]}
    document = {"images": [], "annotations": [*items, 5]}
    assert annotations_by_image(document_of(document)) == expected
    assert annotations_by_image(parse_document(json.dumps(document).encode())) == expected


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not JSON"),
        (b"{", "not JSON"),
        (TEXT.encode()[:-9], "not JSON"),
        (b"\xff\xfe{}", "not JSON"),
        (b"\x89PNG\r\n\x1a\n", "not JSON"),
        (gzip.compress(TEXT.encode())[:-9], "damaged gzip"),
        (b"\x1f\x8b nothing of the kind", "damaged gzip"),
        (b"null", "neither a COCO file"),
        (b'"images"', "neither a COCO file"),
        (b"{}", "neither a COCO file"),
        (b'{"annotations": []}', "neither a COCO file"),
        (b'{"images": {"1": {}}}', "neither a COCO file"),
        (b'{"images": [], "annotations": {}}', "annotations are not a list"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"images": [], "annotations": [' + b"[" * 50_000 + b"]" * 50_000 + b"]}", "nested too deeply"),
        (b'{"a":' * 50_000, "nested too deeply"),
    ],
    ids=range(16),
)
def test_what_is_no_document_is_refused_by_name(data: bytes, reason: str, tmp_path: Path) -> None:
    with pytest.raises(FairyringError, match=reason):
        parse_document(data)
    file = tmp_path / "labels.json"
    file.write_bytes(data)
    with pytest.raises(FileError, match=reason) as refused:
        read_document(file)
    assert str(refused.value).startswith(f"{file}: ")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"nowhere\.json cannot be read: No such file"):
        read_document(tmp_path / "nowhere.json")
    with pytest.raises(FileError, match="cannot be read: Is a directory"):
        read_document(tmp_path)


def test_a_bomb_is_not_unzipped_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fairyring.model.json_files.MOST_BYTES", 1 << 20)
    with pytest.raises(FairyringError, match="unzips to more than"):
        parse_document(gzip.compress(bytes(1 << 22)))


@pytest.mark.parametrize("data", [b'{"images": [], "a\xbd": 1}', b"[\xbd"])
def test_bytes_of_no_encoding_are_refused_with_a_sentence(data: bytes) -> None:
    with pytest.raises(FairyringError, match="not JSON"):
        parse_document(data)
