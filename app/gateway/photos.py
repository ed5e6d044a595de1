"""Photos for the browser, upright and 8 bits: the file itself where that will do, else a conversion."""

from __future__ import annotations

import logging
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import anyio
import anyio.to_thread
import PIL.Image
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response

from fairyring.app.addresses import content_of
from fairyring.app.gateway.login import name_of
from fairyring.app.gateway.photo_copies import AS_IT_IS, Wanted, photo_copy
from fairyring.app.workers.crew import Run, here
from fairyring.model.errors import FairyringError
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.originals import PhotoChangedError, PhotoGoneError
from fairyring.storage.project import Project
from fairyring.storage.records import Image

log = logging.getLogger(__name__)

FOR_EVER = "private, max-age=31536000, immutable"
WIDTHS = (160, 500, 1000, 2000, 4000)
"""Widths a photo is scaled down to; others are rounded up, so that the cache cannot be flooded."""
COPY_TYPE = "image/jpeg"
DIRECT_FORMATS = frozenset({"JPEG", "PNG", "WEBP"})
DIRECT_MODES = frozenset({"1", "L", "P", "RGB", "RGBA"})
LARGEST_ID = 2**63 - 1
EXIF_ORIENTATION = 0x0112
CACHED = "photos"
"""Folder in the project's cache."""


@dataclass(frozen=True, kw_only=True)
class _Copies:
    """Where converted photos are kept, and who makes them."""

    folder: Path
    limit: int
    """Bytes."""
    run: Run


def photos_of(
    project: Project, *, cache_limit: int, run: Run = here
) -> Callable[[Request], Awaitable[Response]]:
    """The endpoint of `PHOTOS`, which takes a width as ``?w=``, and ``?contrast=local`` to even out contrast.

    Photos are decoded by ``run``, and kept in the project's cache as long as they fit ``cache_limit``, bytes.
    """
    copies = _Copies(folder=project.cache / CACHED, limit=cache_limit, run=run)
    decoding = anyio.CapacityLimiter(2)

    async def photos(request: Request) -> Response:
        if name_of(request) is None:
            return PlainTextResponse("Open the page first and say your name.", status_code=401)
        image = await anyio.to_thread.run_sync(_image_at, project, request.path_params["image"])
        if image is None or request.path_params["content"] != content_of(image):
            return PlainTextResponse("There is no such photo in this project.", status_code=404)
        wanted = Wanted(
            width=_width_wanted(request.query_params.get("w"), image),
            local_contrast=request.query_params.get("contrast") == "local",
        )
        try:
            file, media_type = await anyio.to_thread.run_sync(
                _file_for, project, image, wanted, copies, limiter=decoding
            )
        except PhotoGoneError:
            return PlainTextResponse(f"{image.file_name} is gone; put the photo back.", status_code=404)
        except PhotoChangedError:
            return PlainTextResponse(
                f"{image.file_name} is no longer the photo that was imported, so it is not shown under its "
                "labels; put that photo back.",
                status_code=409,
            )
        except FairyringError as error:
            # Where it lies is nobody's business in a browser.
            log.warning("A photo cannot be shown: %s", error)
            return PlainTextResponse(
                f"{image.file_name} cannot be read; the server's log says why.", status_code=404
            )
        return FileResponse(file, media_type=media_type, headers={"Cache-Control": FOR_EVER})

    return photos


def _image_at(project: Project, image_id: int) -> Image | None:
    if image_id > LARGEST_ID:
        return None
    with project.read() as connection, suppress(StoreError):
        return get_image(connection, image_id)
    return None


def _width_wanted(asked: str | None, image: Image) -> int | None:
    """A width of WIDTHS, or None for the photo at its full size."""
    if asked is None or not (asked.isascii() and asked.isdigit()) or len(asked) > 6:
        return None
    return next((width for width in WIDTHS if int(asked) <= width < image.width), None)


def _file_for(project: Project, image: Image, wanted: Wanted, copies: _Copies) -> tuple[Path, str]:
    """The file to send and its media type.

    Raises FairyringError where the photo is gone, is another or cannot be read.
    """
    source = project.originals.path_of(image)
    if wanted == AS_IT_IS and (media_type := type_shown_as_it_is(source)) is not None:
        return source, media_type
    made = copies.folder / f"{image.sha256}-{wanted.width or 'full'}{'-local' * wanted.local_contrast}.jpg"
    if not made.is_file():
        copies.run(photo_copy, source, made, image, wanted)
        make_room(copies.folder, copies.limit)
    return made, COPY_TYPE


def type_shown_as_it_is(source: Path) -> str | None:
    """Media type of a file that every browser shows just as it is decoded here: upright, 8 bits, no CMYK."""
    try:
        with PIL.Image.open(source) as opened:
            # Pillow calls 16-bit colour "RGB"; its decoder knows better, until the EXIF data is read.
            deep = any(";16" in str(tile[3]) for tile in opened.tile)
            upright = opened.getexif().get(EXIF_ORIENTATION, 1) == 1
            shown = upright and not deep and opened.format in DIRECT_FORMATS and opened.mode in DIRECT_MODES
            return PIL.Image.MIME[opened.format or ""] if shown else None
    except (OSError, ValueError, PIL.Image.DecompressionBombError):
        return None


def clear_unfinished(project: Project) -> None:
    """Removes what a killed server was converting; for a server that is alone with the project."""
    for file in (project.cache / CACHED).glob("*"):
        if file.suffix != ".jpg":
            file.unlink(missing_ok=True)


def make_room(cache: Path, limit: int) -> None:
    """Deletes the least recently used photos until the cache fits ``limit`` bytes; the newest stays."""
    files = sorted(((f.stat(), f) for f in cache.glob("*.jpg")), key=lambda entry: entry[0].st_atime)
    total = sum(stat.st_size for stat, _ in files)
    for stat, file in files[:-1]:
        if total <= limit:
            return
        file.unlink(missing_ok=True)
        total -= stat.st_size
