"""Photos as the browser gets them, whatever the file is."""

from __future__ import annotations

import hashlib
import io
import os
from pathlib import Path

import cv2
import httpx
import msgspec
import numpy as np
import PIL.Image
import pytest
from sqlalchemy import update

from fairyring.app.addresses import photo_address
from fairyring.app.gateway import photo_copies, photos
from fairyring.app.gateway.photos import type_shown_as_it_is
from fairyring.storage.db.schema import image as image_table
from fairyring.storage.images import find_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project

ADA = {"Cookie": "fairyring_name=Ada"}
RED, GREEN, BLUE = (200, 30, 30), (30, 200, 30), (30, 30, 200)
ROTATED = 6
"""EXIF: the camera was turned; upright is a quarter turn clockwise."""


def quarters(width: int, height: int) -> PIL.Image.Image:
    """Red in the upper left quarter, green in the upper right, blue below."""
    pixels = np.empty((height, width, 3), np.uint8)
    pixels[:] = BLUE
    pixels[: height // 2, : width // 2] = RED
    pixels[: height // 2, width // 2 :] = GREEN
    return PIL.Image.fromarray(pixels)


def fetch(port: int, path: str) -> tuple[httpx.Response, np.ndarray]:
    """The answer, and its pixels as a browser decodes them, EXIF and all."""
    answer = httpx.get(f"http://127.0.0.1:{port}{path}", headers=ADA)
    assert answer.status_code == 200, answer.text
    with PIL.Image.open(io.BytesIO(answer.content)) as opened:
        assert opened.getexif().get(0x0112, 1) == 1
        return answer, np.asarray(opened.convert("RGB"))


def added(project: Project, file: Path) -> str:
    """The URL of a photo that was taken into the project."""
    report = import_paths(project, [file])
    assert report.images == 1, report.problems
    with project.read() as connection:
        found = find_image(connection, file.name)
    assert found is not None
    return photo_address(found)


def assert_quarters(pixels: np.ndarray) -> None:
    height, width = pixels.shape[:2]
    for (y, x), colour in {(0.25, 0.25): RED, (0.25, 0.75): GREEN, (0.75, 0.5): BLUE}.items():
        assert np.abs(pixels[int(y * height), int(x * width)].astype(int) - colour).max() < 25


def test_a_plain_jpeg_is_sent_as_it_is_and_kept_for_ever(port: int, project: Project, tmp_path: Path) -> None:
    file = tmp_path / "plain.jpg"
    quarters(80, 60).save(file, quality=95)
    answer, _ = fetch(port, added(project, file))
    assert answer.content == file.read_bytes()
    assert answer.headers["content-type"] == "image/jpeg"
    assert "immutable" in answer.headers["cache-control"]


@pytest.mark.parametrize("name", ["bed.jfif", "named_so.png", "bed.jpe"])
def test_a_photo_is_served_by_what_it_is(port: int, project: Project, tmp_path: Path, name: str) -> None:
    quarters(80, 60).save(tmp_path / name, format="JPEG")
    answer, pixels = fetch(port, added(project, tmp_path / name))
    assert answer.headers["content-type"] == "image/jpeg"
    assert_quarters(pixels)


def test_a_turned_photo_comes_upright(port: int, project: Project, tmp_path: Path) -> None:
    file = tmp_path / "turned.jpg"
    exif = PIL.Image.Exif()
    exif[0x0112] = ROTATED
    quarters(60, 80).transpose(PIL.Image.Transpose.ROTATE_90).save(file, quality=95, exif=exif)
    assert type_shown_as_it_is(file) is None
    _, pixels = fetch(port, added(project, file))
    assert pixels.shape == (80, 60, 3)
    assert_quarters(pixels)


@pytest.mark.parametrize("name", ["bed.tif", "cmyk.jpg", "deep.png"])
def test_what_browsers_cannot_show_is_converted(
    port: int, project: Project, tmp_path: Path, name: str
) -> None:
    file = tmp_path / name
    picture = quarters(80, 60)
    if name == "cmyk.jpg":
        picture.convert("CMYK").save(file, quality=95)
    elif name == "deep.png":
        deep = np.asarray(picture).astype(np.uint16)[..., ::-1] * 257
        cv2.imwrite(str(file), deep)
    else:
        picture.save(file)
    answer, pixels = fetch(port, added(project, file))
    assert answer.headers["content-type"] == "image/jpeg"
    assert_quarters(pixels)


def test_a_photo_that_cannot_be_read_is_named_without_its_place(
    port: int, project: Project, tmp_path: Path
) -> None:
    quarters(80, 60).save(tmp_path / "bed.tif")
    address = added(project, tmp_path / "bed.tif")
    broken = project.images / "bed.tif"
    broken.write_bytes(b"II*\0" + bytes(broken.stat().st_size - 4))
    with project.read() as connection:
        found = find_image(connection, "bed.tif")
    assert found is not None
    digest = hashlib.sha256(broken.read_bytes()).hexdigest()
    project.write(
        lambda c: (
            c.execute(update(image_table).where(image_table.c.id == found.id).values(sha256=digest)).rowcount
        )
    )
    address = photo_address(msgspec.structs.replace(found, sha256=digest))
    answer = httpx.get(f"http://127.0.0.1:{port}{address}", headers=ADA)
    assert answer.status_code == 404
    assert answer.text.startswith("bed.tif cannot be read")
    assert str(tmp_path) not in answer.text


def test_a_smaller_copy_has_a_width_of_the_list_and_is_made_once(
    port: int, project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "large.jpg"
    quarters(1200, 900).save(file)
    url = added(project, file)
    _, pixels = fetch(port, f"{url}?w=450")
    assert pixels.shape == (375, 500, 3)
    assert_quarters(pixels)
    monkeypatch.setattr(photo_copies.photo, "read", None)
    assert fetch(port, f"{url}?w=499")[1].shape == (375, 500, 3)


@pytest.mark.parametrize("width", ["1200", "5000", "0", "-1", "1e3", "٣", "9" * 30, "x"])
def test_a_width_that_asks_for_no_less_gives_the_photo_itself(
    port: int, project: Project, tmp_path: Path, width: str
) -> None:
    file = tmp_path / "photo.jpg"
    quarters(120, 90).save(file)
    answer, _ = fetch(port, f"{added(project, file)}?w={width}")
    assert answer.content == file.read_bytes()


@pytest.mark.parametrize("path", ["/photos/1/0000000000000000", "/photos/99/0", "/photos/x/0"])
def test_a_photo_that_is_not_there_is_not_found(shared_port: int, path: str) -> None:
    assert httpx.get(f"http://127.0.0.1:{shared_port}{path}", headers=ADA).status_code == 404


def test_a_number_beyond_the_database_is_not_found(shared_port: int) -> None:
    path = f"/photos/{10**30}/0"
    assert httpx.get(f"http://127.0.0.1:{shared_port}{path}", headers=ADA).status_code == 404


def test_a_photo_taken_away_is_named_in_the_answer(port: int, project: Project) -> None:
    with project.read() as connection:
        found = find_image(connection, "bed_1.jpg")
    assert found is not None
    project.write(
        lambda connection: connection.execute(
            update(image_table).where(image_table.c.id == found.id).values(path="images/gone.jpg")
        )
    )
    answer = httpx.get(f"http://127.0.0.1:{port}{photo_address(found)}", headers=ADA)
    assert answer.status_code == 404
    assert answer.text == "bed_1.jpg is gone; put the photo back."


@pytest.mark.parametrize("width", ["", "?w=160"])
def test_another_photo_in_the_place_of_one_is_not_sent_as_that(
    port: int, project: Project, tmp_path: Path, width: str
) -> None:
    file, other = tmp_path / "bed_3.jpg", tmp_path / "bed_6.jpg"
    quarters(320, 240).save(file)
    quarters(320, 240).transpose(PIL.Image.Transpose.ROTATE_180).save(other)
    url = added(project, file)
    (project.images / "bed_3.jpg").write_bytes(other.read_bytes())

    answer = httpx.get(f"http://127.0.0.1:{port}{url}{width}", headers=ADA)

    assert answer.status_code == 409
    assert answer.text.startswith("bed_3.jpg is no longer the photo that was imported")
    assert "cache-control" not in answer.headers
    assert str(project.folder) not in answer.text

    (project.images / "bed_3.jpg").write_bytes(file.read_bytes())
    assert_quarters(fetch(port, f"{url}{width}")[1])


def test_the_cache_drops_what_was_longest_unused(tmp_path: Path) -> None:
    for age, name in enumerate(("new.jpg", "old.jpg", "older.jpg")):
        file = tmp_path / name
        file.write_bytes(b"x" * 100)
        seconds = 1_700_000_000 - 1000 * age
        os.utime(file, (seconds, seconds))
    photos.make_room(tmp_path, 250)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["new.jpg", "old.jpg"]
    photos.make_room(tmp_path, 0)
    assert [file.name for file in tmp_path.iterdir()] == ["new.jpg"]
