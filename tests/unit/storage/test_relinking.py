"""Photos that are gone from their place are found elsewhere by their bytes."""

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.images import find_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.relinking import missing_photos, relink


def path_of(project, name):
    with project.read() as connection:
        return project.originals.path_of(find_image(connection, name))


@pytest.fixture
def moved(project, tmp_path, write_photo):
    """Two linked photos, of which the folder has another name now, and one was renamed."""
    for name in ("a.png", "b.png"):
        write_photo(tmp_path / "photos" / name)
    import_paths(project, [tmp_path / "photos"], link=True)
    (tmp_path / "photos").rename(tmp_path / "disk")
    (tmp_path / "disk" / "b.png").rename(tmp_path / "disk" / "renamed.png")
    write_photo(tmp_path / "disk" / "b.png", seed=3)
    return project


def test_linked_photos_are_found_by_name_and_by_content(moved, tmp_path):
    assert [image.file_name for image in missing_photos(moved)] == ["a.png", "b.png"]
    relinked = relink(moved, [tmp_path / "disk"])
    assert relinked.missing == []
    assert path_of(moved, "a.png") == tmp_path / "disk" / "a.png"
    assert path_of(moved, "b.png") == tmp_path / "disk" / "renamed.png"
    assert missing_photos(moved) == []


def test_another_photo_of_the_same_name_is_not_taken(moved, tmp_path):
    (tmp_path / "disk" / "renamed.png").unlink()
    assert relink(moved, [tmp_path / "disk"]).missing == ["b.png"]


def test_a_copied_photo_is_copied_again(beds, tmp_path):
    (beds.images / "bed_1.png").rename(tmp_path / "bed_1.png")
    relinked = relink(beds, [tmp_path])
    assert relinked.found == {"bed_1.png": tmp_path / "bed_1.png"}
    assert path_of(beds, "bed_1.png") == beds.images / "bed_1.png"


def test_a_folder_that_is_none_is_refused(beds, tmp_path):
    with pytest.raises(StoreError, match="nowhere is not a folder"):
        relink(beds, [tmp_path / "nowhere"])
