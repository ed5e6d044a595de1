"""Photos that are, and are no longer, what was imported."""

import os
import shutil

import pytest

from fairyring.storage import originals
from fairyring.storage.images import get_image
from fairyring.storage.originals import Originals, PhotoChangedError, PhotoGoneError


@pytest.fixture
def image(beds):
    with beds.read() as connection:
        return get_image(connection, 1)


@pytest.fixture
def reads(monkeypatch):
    """How often a file was read to its end."""
    digest, read = originals.hashlib.file_digest, []

    def counted(file, name):
        read.append(file.name)
        return digest(file, name)

    monkeypatch.setattr(originals.hashlib, "file_digest", counted)
    return read


def test_a_photo_is_read_once_and_again_when_it_was_written(beds, image, reads):
    photos = Originals(beds.folder)
    for _ in range(3):
        assert photos.path_of(image) == beds.images / image.file_name
    assert len(reads) == 1

    os.utime(beds.images / image.file_name)
    assert photos.path_of(image) == beds.images / image.file_name
    assert len(reads) == 2


def test_another_photo_of_the_same_size_and_time_is_not_taken_for_it(beds, image):
    path = beds.images / image.file_name
    photos = Originals(beds.folder)
    photos.path_of(image)
    before = path.stat()
    path.write_bytes(path.read_bytes()[:-1] + b"\x00")
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert (path.stat().st_size, path.stat().st_mtime_ns) == (before.st_size, before.st_mtime_ns)

    with pytest.raises(PhotoChangedError, match="no longer the photo that was imported; put that back"):
        photos.path_of(image)


def test_the_photo_put_back_is_the_photo(beds, image, tmp_path):
    path = beds.images / image.file_name
    photos = Originals(beds.folder)
    shutil.copy2(path, tmp_path / "kept")
    path.write_bytes(b"another")
    with pytest.raises(PhotoChangedError):
        photos.path_of(image)
    path.unlink()
    with pytest.raises(PhotoGoneError, match="is gone; put the photo back"):
        photos.path_of(image)
    shutil.copy2(tmp_path / "kept", path)
    assert photos.path_of(image) == path


def test_what_cannot_be_opened_says_why(beds, image):
    path = beds.images / image.file_name
    path.unlink()
    path.mkdir()
    with pytest.raises(PhotoGoneError, match="Is a directory"):
        Originals(beds.folder).path_of(image)
