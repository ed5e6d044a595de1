"""Photos: copied or left where they are, upright, and the bad ones reported."""

import cv2
import numpy as np
import pytest
from PIL import Image

from fairyring.storage.errors import StoreError
from fairyring.storage.images import find_image
from fairyring.storage.importing.intake import Facts
from fairyring.storage.importing.paths import import_paths
from tests.support.imported import files_of


def test_photos_are_copied_with_size_hash_and_what_was_said_of_them(project, tmp_path, write_photo):
    photo = write_photo(tmp_path / "in" / "Bed 1.PNG", width=64, height=48)
    report = import_paths(project, [photo], unsaid=Facts(light="side", form="c"))
    assert (report.images, report.images_known, report.problems) == (1, 0, [])
    with project.read() as connection:
        image = find_image(connection, "Bed 1.PNG")
    assert (image.width, image.height, image.light, image.form, image.status) == (64, 48, "side", "c", "new")
    assert image.path == "images/Bed 1.PNG"
    assert (project.folder / image.path).read_bytes() == photo.read_bytes()


def test_photos_can_stay_where_they_are(project, tmp_path, write_photo):
    photo = write_photo(tmp_path / "in" / "bed.png")
    import_paths(project, [photo], link=True)
    with project.read() as connection:
        assert find_image(connection, "bed.png").path == str(photo)
    assert files_of(project) == []


def test_a_folder_is_searched_to_the_bottom(project, tmp_path, write_photo):
    folder = tmp_path / "in"
    for name in ("b.png", "day 2/a.jpg", ".hidden.png", ".git/c.png"):
        write_photo(folder / name)
    (folder / "notes.txt").write_text("rain")
    (folder / "link.png").symlink_to(folder / "b.png")
    assert import_paths(project, [folder]).images == 2
    assert files_of(project) == ["a.jpg", "b.png"]


def test_bad_photos_are_reported_by_name_and_the_good_ones_taken(project, tmp_path, write_photo):
    folder = tmp_path / "in"
    whole = write_photo(folder / "good.jpg")
    (folder / "broken.jpg").write_bytes(whole.read_bytes()[:700])
    (folder / "empty.jpg").write_bytes(b"")
    (folder / "text.jpg").write_text("not a photo")
    report = import_paths(project, [folder])
    assert report.images == 1
    assert sorted(problem.file.rsplit("/", 1)[-1] for problem in report.problems) == [
        "broken.jpg",
        "empty.jpg",
        "text.jpg",
    ]
    assert files_of(project) == ["good.jpg"]


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("nowhere", "does not exist"),
        ("beds.zip", "is an archive; unpack it"),
        ("empty", "no photo or file of labels"),
    ],
)
def test_paths_that_hold_nothing_are_refused(project, tmp_path, name, reason):
    (tmp_path / "empty").mkdir()
    (tmp_path / "beds.zip").write_bytes(b"PK")
    with pytest.raises(StoreError, match=reason):
        import_paths(project, [tmp_path / name])


def test_an_exif_rotated_photo_is_upright_in_the_project(project, tmp_path):
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("RGB", (60, 40)).save(tmp_path / "turned.jpg", exif=exif)
    import_paths(project, [tmp_path / "turned.jpg"])
    with project.read() as connection:
        image = find_image(connection, "turned.jpg")
    assert (image.width, image.height) == (40, 60)


def test_a_16_bit_photo_is_taken(project, tmp_path):
    cv2.imwrite(str(tmp_path / "deep.png"), np.full((20, 30), 40000, np.uint16))
    assert import_paths(project, [tmp_path / "deep.png"]).images == 1


def test_a_photo_lying_in_the_project_already_is_taken_where_it_lies(project, write_photo):
    write_photo(project.images / "bed.png")
    assert import_paths(project, [project.images]).images == 1
    assert files_of(project) == ["bed.png"]


def test_a_strange_file_in_the_way_is_not_overwritten(project, tmp_path, write_photo):
    stranger = write_photo(project.images / "bed.png", seed=9)
    content = stranger.read_bytes()
    with pytest.raises(StoreError, match="is in the way of"):
        import_paths(project, [write_photo(tmp_path / "bed.png")])
    assert stranger.read_bytes() == content
