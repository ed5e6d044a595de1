"""Addresses that the server gives to the browser, each written once: the photos and the downloads."""

from __future__ import annotations

from urllib.parse import urlencode

from fairyring.storage.records import Image

PHOTOS = "/photos/{image:int}/{content}"
"""Route of the photos; ``content`` is what `content_of` says, so another content has another address."""
UPLOADS = "/uploads"
"""Route to which the browser sends photos."""
DOWNLOADS = "/downloads/{name}"
"""Route of the files that jobs have made."""

REVIEWS = "/review/{what}"
"""Route of a review to print, and of its plots and tables to keep."""


def content_of(image: Image) -> str:
    """The first 16 hex digits of the photo's SHA-256."""
    return image.sha256[:16]


def photo_address(image: Image) -> str:
    """Where the browser finds a photo."""
    return f"/photos/{image.id}/{content_of(image)}"


def review_address(
    what: str, *, only_sure: bool = False, image: int | None = None, run: int | None = None
) -> str:
    """Where the browser finds a review, one of its plots, or a table of it.

    It is of all images, or of one; against a run, or the latest of each image.
    """
    asked = {"sure": "1" if only_sure else None, "image": image, "run": run}
    query = urlencode({name: value for name, value in asked.items() if value is not None})
    return f"/review/{what}?{query}" if query else f"/review/{what}"


def download_address(file_name: str) -> str:
    """Where the browser finds a file that a job has made."""
    return f"/downloads/{file_name}"
