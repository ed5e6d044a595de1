"""Photos of an export: linked, left out, or gone."""

import json

import pytest
from PIL import Image

from fairyring.storage.choices import ExportedPhotos, Only
from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import Wanted, export_coco
from fairyring.storage.importing.paths import import_paths


def names_in(out):
    return [image["file_name"] for image in json.loads((out / "instances.json").read_text())["images"]]


def test_a_photo_that_is_gone_ends_an_export_unless_it_may_be_skipped(beds, out):
    (beds.images / "bed_2.png").unlink()
    with pytest.raises(StoreError, match=r"bed_2\.png is gone.*--skip-missing"):
        export_coco(beds, out, Wanted(only=Only.all))
    report = export_coco(beds, out, Wanted(only=Only.all, skip_missing=True))
    assert names_in(out) == ["bed_1.png", "bed_10.png"]
    (said,) = report.left_out
    assert "bed_2.png is gone" in said


def test_labels_alone_need_no_photos(beds, out):
    (beds.images / "bed_2.png").unlink()
    export_coco(beds, out, Wanted(only=Only.all, photos=ExportedPhotos.none))
    assert names_in(out) == ["bed_1.png", "bed_2.png", "bed_10.png"]
    assert [file.name for file in out.iterdir()] == ["instances.json"]


def test_linked_photos_are_those_of_the_project_but_for_turned_ones(beds, out, tmp_path):
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("RGB", (60, 40)).save(tmp_path / "turned.jpg", exif=exif)
    import_paths(beds, [tmp_path / "turned.jpg"])
    export_coco(beds, out, Wanted(only=Only.all, photos=ExportedPhotos.linked))
    assert (out / "images" / "bed_1.png").readlink() == beds.images.resolve() / "bed_1.png"
    assert not (out / "images" / "turned.jpg").is_symlink()
    with Image.open(out / "images" / "turned.jpg") as upright:
        assert upright.size == (40, 60)


def test_photos_in_folders_keep_them(project, out, tmp_path, write_photo):
    for seed, day in enumerate(("monday", "tuesday")):
        write_photo(tmp_path / "days" / day / "bed.png", seed=seed)
    import_paths(project, [tmp_path / "days"])
    export_coco(project, out, Wanted(only=Only.all))
    assert names_in(out) == ["monday/bed.png", "tuesday/bed.png"]
    assert (out / "images" / "tuesday" / "bed.png").read_bytes() == (
        tmp_path / "days/tuesday/bed.png"
    ).read_bytes()


@pytest.mark.parametrize("ending", ["jpg", "jfif", "png", "webp"])
def test_a_turned_photo_is_written_upright_without_a_word(project, out, tmp_path, capfd, ending):
    exif = Image.Exif()
    exif[0x0112] = 6
    kind = "JPEG" if ending == "jfif" else None
    Image.new("RGB", (60, 40)).save(tmp_path / f"turned.{ending}", format=kind, exif=exif)
    import_paths(project, [tmp_path / f"turned.{ending}"])
    export_coco(project, out, Wanted(only=Only.all))
    with Image.open(out / "images" / f"turned.{ending}") as upright:
        assert upright.size == (40, 60)
    assert capfd.readouterr().err == ""
