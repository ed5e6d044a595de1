"""Photos of every kind the right way up, and broken ones refused with the remedy."""

from __future__ import annotations

import hashlib
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from fairyring.model.photo import PhotoError, probe, read

# Four fields of one colour each (BGR), so that lossy formats keep their middles.
TOP_LEFT, TOP_RIGHT = (200, 40, 20), (30, 180, 60)
BOTTOM_LEFT, BOTTOM_RIGHT = (20, 60, 220), (240, 240, 240)
UPRIGHT = np.zeros((48, 64, 3), np.uint8)
UPRIGHT[:24, :32], UPRIGHT[:24, 32:] = TOP_LEFT, TOP_RIGHT
UPRIGHT[24:, :32], UPRIGHT[24:, 32:] = BOTTOM_LEFT, BOTTOM_RIGHT

STORED_AS = {
    1: lambda a: a,
    2: lambda a: a[:, ::-1],
    3: lambda a: a[::-1, ::-1],
    4: lambda a: a[::-1],
    5: lambda a: a.swapaxes(0, 1),
    6: lambda a: np.rot90(a, 1),
    7: lambda a: a[::-1, ::-1].swapaxes(0, 1),
    8: lambda a: np.rot90(a, -1),
}
"""EXIF orientation to what the camera wrote for the upright photo, by the standard's table."""


def pil(bgr: np.ndarray) -> Image.Image:
    return Image.fromarray(np.ascontiguousarray(bgr[..., ::-1]))


def fields(photo: np.ndarray) -> np.ndarray:
    """(4, 3) colours of the four fields' middles."""
    height, width = photo.shape[:2]
    return np.array([photo[height * r // 4, width * c // 4] for r in (1, 3) for c in (1, 3)], int)


COLOURS = np.array([TOP_LEFT, TOP_RIGHT, BOTTOM_LEFT, BOTTOM_RIGHT])


@pytest.mark.parametrize("suffix", ["jpg", "png", "webp", "tiff"])
@pytest.mark.parametrize("orientation", STORED_AS)
def test_a_turned_photo_is_read_upright(tmp_path: Path, suffix: str, orientation: int) -> None:
    path = tmp_path / f"turned.{suffix}"
    exif = Image.Exif()
    exif[0x0112] = orientation
    quality = {"quality": 95} if suffix in ("jpg", "webp") else {}
    pil(STORED_AS[orientation](UPRIGHT)).save(path, exif=exif, **quality)

    info, photo = probe(path), read(path)

    assert (info.width, info.height, info.orientation) == (64, 48, orientation)
    assert photo.shape == (48, 64, 3)
    assert fields(photo) == pytest.approx(COLOURS, abs=12)


def test_an_orientation_that_does_not_exist_is_upright(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 9
    pil(UPRIGHT).save(tmp_path / "a.jpg", exif=exif)

    assert probe(tmp_path / "a.jpg").orientation == 1


@pytest.mark.parametrize("suffix", ["png", "tiff", "bmp"])
def test_lossless_photos_keep_every_value(tmp_path: Path, suffix: str) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (31, 45, 3), dtype=np.uint8)
    pil(noise).save(tmp_path / f"a.{suffix}")

    assert np.array_equal(read(tmp_path / f"a.{suffix}"), noise)


@pytest.mark.parametrize("suffix", ["png", "tiff"])
@pytest.mark.parametrize(("brightest", "shift"), [(65535, 8), (16383, 6), (4095, 4), (1023, 2), (255, 0)])
def test_16_bit_photos_are_scaled_by_the_depth_they_use(
    tmp_path: Path, suffix: str, brightest: int, shift: int
) -> None:
    deep = np.linspace(0, brightest, 40 * 30 * 3).round().astype(np.uint16).reshape(30, 40, 3)
    cv2.imwrite(str(tmp_path / f"a.{suffix}"), deep)

    probe(tmp_path / f"a.{suffix}")
    assert np.array_equal(read(tmp_path / f"a.{suffix}"), (deep >> shift).astype(np.uint8))


@pytest.mark.parametrize("mode", ["1", "L", "I;16"])
@pytest.mark.parametrize("suffix", ["png", "tiff"])
def test_grey_photos_have_three_equal_channels(tmp_path: Path, suffix: str, mode: str) -> None:
    grey = np.zeros((20, 30), np.uint8)
    grey[:, 15:] = 255
    picture = Image.fromarray(grey.astype(np.uint16) * 257 if mode == "I;16" else grey)
    (picture.convert("1") if mode == "1" else picture).save(tmp_path / f"a.{suffix}")

    assert np.array_equal(read(tmp_path / f"a.{suffix}"), np.dstack([grey] * 3))


@pytest.mark.parametrize("suffix", ["jpg", "tiff"])
def test_cmyk_photos_show_their_colours(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a.{suffix}"
    pil(UPRIGHT).convert("CMYK").save(path)

    assert fields(read(path)) == pytest.approx(COLOURS, abs=12)
    assert (probe(path).width, probe(path).height) == (64, 48)


def test_palette_photos_show_their_colours(tmp_path: Path) -> None:
    pil(UPRIGHT).convert("P", palette=Image.Palette.ADAPTIVE).save(tmp_path / "a.png")

    assert fields(read(tmp_path / "a.png")) == pytest.approx(COLOURS, abs=2)


@pytest.mark.parametrize("suffix", ["png", "webp"])
def test_what_is_transparent_lies_over_black(tmp_path: Path, suffix: str) -> None:
    alpha = np.zeros((48, 64, 1), np.uint8)
    alpha[:, :16], alpha[:, 16:48] = 255, 128
    rgba = np.concatenate([np.full((48, 64, 3), 200, np.uint8), alpha], axis=2)
    Image.fromarray(rgba).save(tmp_path / f"a.{suffix}", lossless=True)

    photo = read(tmp_path / f"a.{suffix}")

    # 200 · 128 / 255 = 100.4
    assert [photo[24, x, 0] for x in (8, 32, 56)] == pytest.approx([200, 100, 0], abs=1)


@pytest.mark.parametrize("suffix", ["jpg", "png"])
@pytest.mark.parametrize("longest", [1, 7, 64, 100, 200, 399, 400, 1000])
def test_a_photo_is_shrunk_to_the_longest_side_and_never_enlarged(
    tmp_path: Path, suffix: str, longest: int
) -> None:
    path = tmp_path / f"a.{suffix}"
    pil(cv2.resize(UPRIGHT, (400, 300), interpolation=cv2.INTER_NEAREST)).save(path, quality=95)

    photo = read(path, longest=longest)

    assert max(photo.shape) == max(3, min(longest, 400))
    if longest >= 64:
        assert photo.shape[1] / photo.shape[0] == pytest.approx(4 / 3, abs=0.03)
        assert fields(photo) == pytest.approx(COLOURS, abs=12)


def test_a_turned_jpeg_is_shrunk_the_right_way_up(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    large = cv2.resize(UPRIGHT, (640, 480), interpolation=cv2.INTER_NEAREST)
    pil(STORED_AS[6](large)).save(tmp_path / "a.jpg", exif=exif)

    photo = read(tmp_path / "a.jpg", longest=100)

    assert photo.shape == (75, 100, 3)
    assert fields(photo) == pytest.approx(COLOURS, abs=12)


def test_the_hash_is_that_of_the_file(tmp_path: Path) -> None:
    pil(UPRIGHT).save(tmp_path / "a.png")

    expected = hashlib.sha256((tmp_path / "a.png").read_bytes()).hexdigest()
    assert probe(tmp_path / "a.png").sha256 == expected


@pytest.mark.parametrize("suffix", ["jpg", "png", "tiff", "webp", "bmp"])
@pytest.mark.parametrize("share", [0.2, 0.9])
def test_a_photo_that_breaks_off_is_refused(tmp_path: Path, suffix: str, share: float) -> None:
    path = tmp_path / f"a.{suffix}"
    noise = np.random.default_rng(2).integers(0, 256, (200, 300, 3), dtype=np.uint8)
    pil(noise).save(path)
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])

    with pytest.raises(PhotoError, match=r"copy it again|not a photo") as refusal:
        probe(path)
    assert str(path) in str(refusal.value)


@pytest.mark.parametrize("what", [probe, read])
@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b"These are my notes about the bed.", "not a photo"),
        (b"GIF89a" + bytes(50), "not a photo"),
        (b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n", "not a photo"),
        (b"\xff\xd8\xff\xe0" + bytes(20), "damaged|not a photo"),
    ],
)
def test_what_is_no_photo_is_refused_by_name(
    tmp_path: Path, what: Callable[[Path], object], content: bytes, reason: str
) -> None:
    path = tmp_path / "bed.jpg"
    path.write_bytes(content)

    with pytest.raises(PhotoError, match=reason) as refusal:
        what(path)
    assert str(path) in str(refusal.value)


def png_header(width: int, height: int) -> bytes:
    """The start of a PNG that promises so many pixels."""
    header = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + header + struct.pack(">I", zlib.crc32(header))


def test_an_image_bomb_is_refused_before_it_is_decoded(tmp_path: Path) -> None:
    path = tmp_path / "bomb.png"
    data = b"IDAT" + zlib.compress(bytes(1000))
    chunk = struct.pack(">I", len(data) - 4) + data + struct.pack(">I", zlib.crc32(data))
    path.write_bytes(png_header(40_000, 30_000) + chunk)

    for what in (probe, read):
        with pytest.raises(PhotoError, match="40000 × 30000 pixels, more than the 250 million"):
            what(path)


def test_the_limit_can_be_set(tmp_path: Path) -> None:
    pil(UPRIGHT).save(tmp_path / "a.png")

    assert probe(tmp_path / "a.png", max_pixels=64 * 48).width == 64
    with pytest.raises(PhotoError, match="raise the limit"):
        probe(tmp_path / "a.png", max_pixels=64 * 48 - 1)


def test_a_photo_of_more_than_pillow_s_own_limit_is_taken(tmp_path: Path) -> None:
    # Pillow refuses above 179 million pixels unless told otherwise.
    Image.new("1", (20_000, 9_100)).save(tmp_path / "wide.png", compress_level=1)

    info = probe(tmp_path / "wide.png")

    assert (info.width, info.height) == (20_000, 9_100)


def test_floating_point_photos_are_refused(tmp_path: Path) -> None:
    Image.fromarray(np.ones((5, 5), np.float32)).save(tmp_path / "a.tiff")

    with pytest.raises(PhotoError, match="32 bits"):
        probe(tmp_path / "a.tiff")


def test_a_missing_photo_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(PhotoError, match="cannot be opened"):
        probe(tmp_path / "gone.jpg")
    with pytest.raises(PhotoError, match="cannot be opened"):
        read(tmp_path)
