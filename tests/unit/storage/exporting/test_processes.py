"""Labels written by several processes."""

from __future__ import annotations

from fairyring.storage import exporting
from fairyring.storage.exporting import export_coco
from fairyring.storage.records import Cap
from tests.support.exported import SQUARE, store


def test_several_processes_write_what_one_writes(beds, tmp_path, monkeypatch):
    store(beds, Cap(visible=[SQUARE]))
    export_coco(beds, tmp_path / "one")
    monkeypatch.setattr(exporting, "WORTH_PROCESSES", 1)
    export_coco(beds, tmp_path / "several", jobs=2)
    one, several = ((tmp_path / name / "instances.json").read_bytes() for name in ("one", "several"))
    assert one == several
    assert b"segmentation" in one
