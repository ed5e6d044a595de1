"""Answers compressed the way the browser asks for, each content once."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from functools import lru_cache

import zstandard
from starlette.requests import Request
from starlette.responses import Response

FOR_EVER = "public, max-age=31536000, immutable"
"""Cache-Control of what has a hash of its content in its address."""
LEAST_BYTES = 200
"""Below, compressing is not worth the header that tells of it."""

ENCODERS: dict[str, Callable[[bytes], bytes]] = {
    # Seven per cent more than the best it can do, in a tenth of the time.
    "zstd": lambda content: zstandard.ZstdCompressor(level=9).compress(content),
    "gzip": lambda content: gzip.compress(content, compresslevel=6, mtime=0),
}
"""By their names in HTTP, the one that makes least first."""


def compressed(request: Request, content: bytes, *, media_type: str, cache_control: str) -> Response:
    """The content, in the best encoding that the request accepts."""
    encoding = encoding_for(request.headers.get("accept-encoding", ""))
    headers = {"Cache-Control": cache_control, "Vary": "Accept-Encoding"}
    if encoding is not None and len(content) >= LEAST_BYTES:
        content = _encoded(content, encoding)
        headers["Content-Encoding"] = encoding
    return Response(content, media_type=media_type, headers=headers)


def encoding_for(accepted: str) -> str | None:
    """The first of ENCODERS that an Accept-Encoding header names, not refused by a weight of 0."""
    offers = [offer.partition(";") for offer in accepted.lower().split(",")]
    wanted = {name.strip() for name, _, weight in offers if weight.replace(" ", "").rstrip("0.") != "q="}
    return next((encoding for encoding in ENCODERS if encoding in wanted), None)


@lru_cache(maxsize=512)
def _encoded(content: bytes, encoding: str) -> bytes:
    return ENCODERS[encoding](content)
