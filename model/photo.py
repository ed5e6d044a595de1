"""Photos from files: what they are, checked to the last byte, and their pixels the right way up.

Pillow reads headers and finds what is broken; OpenCV decodes. Of a file with several pages or frames the
first counts.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray
from PIL import Image, ImageFile, UnidentifiedImageError

from fairyring.model.errors import FairyringError

# The limit is applied here instead, to the size in the header, before a pixel is decoded.
Image.MAX_IMAGE_PIXELS = None

MAX_PIXELS = 250_000_000
FORMATS = ("JPEG", "PNG", "TIFF", "WEBP", "BMP")
SUFFIXES = (".jpg", ".jpeg", ".jpe", ".jfif", ".png", ".tif", ".tiff", ".webp", ".bmp")
"""Lower-case endings of files that may be photos."""
ORIENTATION = 0x0112
DEEP_MODES = ("F", "I")
"""Pillow's names for 32 bits a pixel, floating or whole: no scale to grey is known."""
BITS = (8, 10, 12, 14, 16)
"""Depths that cameras write into 16-bit files."""

Pixels = NDArray[np.uint8]
"""A photo's pixels: (height, width, 3) uint8, BGR."""


class PhotoError(FairyringError):
    """A file that cannot be read as a photo; the sentence names it and says what to do."""


class PhotoInfo(Struct, frozen=True, kw_only=True):
    """A photo that decodes completely."""

    width: int
    """Width of the upright photo, pixels, as all coordinates are."""
    height: int
    orientation: int
    """EXIF orientation in the file, 1 to 8; from 5 on the file's rows are the upright photo's columns."""
    sha256: str
    """SHA-256 of the file."""


def probe(path: Path | str, *, max_pixels: int = MAX_PIXELS) -> PhotoInfo:
    """Reads a photo to its end and says what it is. Raises PhotoError unless it can be used."""
    path = Path(path)
    with _opened(path, max_pixels) as image:
        orientation = _orientation(image)
        width, height = _upright_size(image, orientation)
        # A JPEG shrunk while it is decoded takes a fraction of the time, and all its bytes are read.
        image.draft(None, (1, 1))
        image.load()
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return PhotoInfo(width=width, height=height, orientation=orientation, sha256=digest)


def read(path: Path | str, *, longest: int | None = None, max_pixels: int = MAX_PIXELS) -> Pixels:
    """The photo upright, (height, width, 3) uint8 BGR, no side longer than ``longest`` (never enlarged).

    16-bit photos are scaled by the depth they use (8, 10, 12, 14 or 16 bits), what is transparent is laid
    over black, colour profiles are left aside. A photo that breaks off is for ``probe`` to find: here its
    missing rows may come out grey. Raises PhotoError.
    """
    path = Path(path)
    with _opened(path, max_pixels) as image:
        orientation = _orientation(image)
        if _needs_pillow(image, orientation):
            pixels, orientation = _pillow_pixels(image), 1
        else:
            pixels = _opencv_pixels(path, _reduction(image, longest))
    if pixels is None:
        raise _damaged(path)
    return _shrunk(_upright(_bgr(pixels), orientation), longest)


@contextmanager
def _opened(path: Path, max_pixels: int) -> Iterator[ImageFile.ImageFile]:
    """The photo with its header read and checked; whatever goes wrong with it becomes a PhotoError."""
    try:
        if path.stat().st_size == 0:
            raise PhotoError(f"{path} is empty (0 bytes); copy it again from where it came.")
        with Image.open(path, formats=FORMATS) as image:
            _check_header(path, image, max_pixels)
            yield image
    except PhotoError:
        raise
    except UnidentifiedImageError:
        raise PhotoError(
            f"{path} is not a photo that can be read; save it as JPEG, PNG, TIFF, WebP or BMP."
        ) from None
    except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
        raise PhotoError(
            f"{path} cannot be opened ({error.strerror}); check the path and its rights."
        ) from None
    # Decoders meet broken files with almost any exception: struct.error, KeyError, zlib.error, cv2.error …
    except Exception as error:
        raise _damaged(path) from error


def _check_header(path: Path, image: ImageFile.ImageFile, max_pixels: int) -> None:
    width, height = image.size
    if width * height > max_pixels:
        raise PhotoError(
            f"{path} has {width} × {height} pixels, more than the {max_pixels / 1e6:g} million allowed;"
            " scale it down, or raise the limit."
        )
    if image.mode in DEEP_MODES:
        raise PhotoError(f"{path} has 32 bits a pixel, which no screen shows; save it with 8 or 16.")


def _damaged(path: Path) -> PhotoError:
    return PhotoError(f"{path} is damaged or breaks off before its end; copy it again from where it came.")


def _orientation(image: ImageFile.ImageFile) -> int:
    value = image.getexif().get(ORIENTATION, 1)
    return value if isinstance(value, int) and 1 <= value <= 8 else 1


def _upright_size(image: ImageFile.ImageFile, orientation: int) -> tuple[int, int]:
    width, height = image.size
    # Pillow turns a TIFF by itself, and says so in its size.
    return (height, width) if orientation >= 5 and image.format != "TIFF" else (width, height)


def _needs_pillow(image: ImageFile.ImageFile, orientation: int) -> bool:
    """OpenCV fails on turned TIFFs and takes their CMYK for BGR and alpha."""
    return image.format == "TIFF" and (orientation != 1 or image.mode in ("CMYK", "LAB"))


def _pillow_pixels(image: ImageFile.ImageFile) -> NDArray[Any]:
    if image.mode.startswith("I;16"):
        return np.asarray(image)
    if image.mode in ("RGBA", "LA", "PA"):
        return np.asarray(image.convert("RGBA"))[..., [2, 1, 0, 3]]
    return np.asarray(image.convert("RGB"))[..., ::-1]


def _reduction(image: ImageFile.ImageFile, longest: int | None) -> int:
    """By how much OpenCV may shrink a JPEG as it decodes it, without falling below ``longest``."""
    if longest is None or image.format not in ("JPEG", "MPO"):
        return 1
    return next((factor for factor in (8, 4, 2) if max(image.size) >= longest * factor), 1)


def _opencv_pixels(path: Path, reduction: int) -> NDArray[Any] | None:
    flags = {
        1: cv2.IMREAD_UNCHANGED,
        2: cv2.IMREAD_REDUCED_COLOR_2,
        4: cv2.IMREAD_REDUCED_COLOR_4,
        8: cv2.IMREAD_REDUCED_COLOR_8,
    }[reduction]
    return cv2.imdecode(np.fromfile(path, np.uint8), flags | cv2.IMREAD_IGNORE_ORIENTATION)


def _bgr(pixels: NDArray[Any]) -> Pixels:
    """Grey, BGR or BGRA of 8 or 16 bits as 8-bit BGR."""
    if pixels.dtype == np.uint16:
        used = next(bits for bits in BITS if int(pixels.max()) < 1 << bits)
        pixels = (pixels >> (used - 8)).astype(np.uint8)
    if pixels.ndim == 2:
        return np.repeat(pixels[:, :, None], 3, axis=2)
    if pixels.shape[2] == 3:
        return pixels
    colour, alpha = pixels[..., :3], pixels[..., 3:].astype(np.uint16)
    return ((colour * alpha + 127) // 255).astype(np.uint8)


def _upright(pixels: Pixels, orientation: int) -> Pixels:
    """Undoes an EXIF orientation."""
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return np.ascontiguousarray(pixels)


def _shrunk(pixels: Pixels, longest: int | None) -> Pixels:
    height, width = pixels.shape[:2]
    if longest is None or max(height, width) <= longest:
        return pixels
    scale = longest / max(height, width)
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return cv2.resize(pixels, size, interpolation=cv2.INTER_AREA).astype(np.uint8, copy=False)
