"""Sets of beds on disk: the same whoever renders them and however often they are interrupted."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import pytest
from pycocotools.coco import COCO

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import points_of_part
from fairyring.model.scene.bed import render_bed
from fairyring.model.scene.dataset import write_beds
from fairyring.model.scene.settings import SceneError
from tests.support.small_beds import small


def contents(folder: Path) -> dict[str, bytes]:
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("beds") / "made"
    assert write_beds(out, small(), count=3, seed=4) == 3
    return out


def test_a_set_is_one_coco_file_and_its_images(made: Path) -> None:
    assert list(contents(made)) == [
        *(f"images/bed_0000{n}.jpg" for n in range(3)),
        "instances.json",
    ]


def test_several_processes_write_the_same_bytes(made: Path, tmp_path: Path) -> None:
    write_beds(tmp_path / "two", small(), count=3, seed=4, jobs=2)
    assert contents(tmp_path / "two") == contents(made)


def test_a_set_stopped_half_way_is_continued_to_the_same_bytes(made: Path, tmp_path: Path) -> None:
    def stop(done: int, _total: int, _what: str) -> None:
        if done == 2:
            raise KeyboardInterrupt

    out = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        write_beds(out, small(), count=3, seed=4, progress=stop)
    assert not (out / "instances.json").exists()
    assert write_beds(out, small(), count=3, seed=4, resume=True) == 1
    assert contents(out) == contents(made)


def test_a_finished_set_can_be_added_to(made: Path, tmp_path: Path) -> None:
    out = tmp_path / "grown"
    write_beds(out, small(), count=2, seed=4)
    assert write_beds(out, small(), count=3, seed=4, resume=True) == 1
    assert contents(out) == contents(made)
    assert write_beds(out, small(), count=3, seed=4, resume=True) == 0
    assert contents(out) == contents(made)


def test_a_folder_with_anything_else_in_it_is_refused_and_left_alone(made: Path, tmp_path: Path) -> None:
    before = contents(made)
    with pytest.raises(SceneError, match="not empty"):
        write_beds(made, small(), count=3, seed=4)
    with pytest.raises(SceneError, match="another seed"):
        write_beds(made, small(), count=3, seed=5, resume=True)
    assert contents(made) == before
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(SceneError, match="not begun"):
        write_beds(tmp_path, small(), count=1, seed=4, resume=True)
    with pytest.raises(SceneError, match="is a file"):
        write_beds(tmp_path / "notes.txt", small(), count=1, seed=4)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "instances.json").write_text("[]")
    with pytest.raises(SceneError, match="no set of rendered beds"):
        write_beds(tmp_path / "other", small(), count=1, seed=4, resume=True)


def test_pycocotools_reads_the_file_and_the_keys_hold_the_truth(made: Path) -> None:
    coco = COCO(str(made / "instances.json"))
    for image in coco.loadImgs(coco.getImgIds()):
        bed = render_bed(small(), seed=4, index=image["id"] - 1)
        assert (image["light"], image["form"]) == (bed.light, bed.form)
        entries = coco.loadAnns(coco.getAnnIds(imgIds=image["id"]))
        assert len(entries) == len(bed.caps)
        for entry, cap in zip(entries, bed.caps, strict=True):
            assert entry["center"] == pytest.approx(cap.centre, abs=1e-3)
            assert entry["ellipse"][:2] == entry["center"]
            assert entry["visible_fraction"] + entry["occlude_rate"] == pytest.approx(1)
            assert entry["order"] == cap.order
            (whole,) = entry["amodal_segmentation"]
            assert points_of_part(whole) == pytest.approx(points_of_part(cap.whole), abs=1e-3)
            drawn = mask_of_outline(entry["segmentation"], height=200, width=320)
            told = mask_of_outline(cap.visible, height=200, width=320)
            assert (drawn == told).all()


def test_the_photo_is_the_bed_as_a_jpeg(made: Path) -> None:
    stored = cv2.imread(str(made / "images" / "bed_00001.jpg")).astype(int)
    assert abs(stored - render_bed(small(), seed=4, index=1).image).mean() < 4


def test_nothing_in_the_file_is_dated(made: Path) -> None:
    assert set(json.loads((made / "instances.json").read_text())["info"]) == {
        "description",
        "seed",
        "settings",
    }
