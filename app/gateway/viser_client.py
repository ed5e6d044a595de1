"""viser's client, taken apart so that the browser can keep it: its module, its styles, its decoder.

viser ships one HTML file in which a small inline script unpacks a stylesheet and a module (base 88, zstd)
at every visit, with a decoder in WebAssembly that it carries along and that the module uses as well.
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import viser
import zstandard
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from fairyring.app.gateway.compressed import FOR_EVER, compressed
from fairyring.app.gateway.static_files import media_type_of, version_of
from fairyring.app.static_folder import STATIC
from fairyring.model.errors import FairyringError

START, MODULE, STYLES, DECODER = "start.js", "client.js", "client.css", "zstd.wasm"
WASM = "application/wasm"

_DIGITS = "!#$%()*+,-./0123456789:;=?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_abcdefghijklmnopqrstuvwxyz{|}~"
_BOOTSTRAP = re.compile(
    r'<script data-p="(?P<packed>[^"]*)" data-ss="(?P<style>\d+)" data-cs="(?P<code>\d+)">'
    r'.*?gzWasm="(?P<decoder>(?:[^"\\]|\\.)*)".*?__viserZstdWasm=.*?</script>',
    re.DOTALL,
)


@dataclass(frozen=True, eq=False)
class ViserClient:
    """viser's page without what it carries, and what it carries."""

    before: str
    """The page up to where the script was, and"""
    after: str
    """from there on."""
    files: Mapping[str, bytes]
    version: str

    def url(self, name: str) -> str:
        """Where the browser finds a file."""
        return f"/viser/{self.version}/{name}"


@cache
def load_viser() -> ViserClient:
    """Takes viser's index.html apart.

    Raises FairyringError where the installed viser's page is not built as this version expects.
    """
    index = Path(viser.__file__).parent / "client" / "build" / "index.html"
    page = index.read_text(encoding="utf-8")
    bootstrap = _BOOTSTRAP.search(page)
    if bootstrap is None or "</head>" not in page[bootstrap.end() :]:
        raise FairyringError(f"{index} is not the page of viser 1.1.1; install viser==1.1.1 again.")
    style_length = int(bootstrap["style"])
    packed = from_base88(bootstrap["packed"])
    unpacked = zstandard.decompress(packed, max_output_size=style_length + int(bootstrap["code"]))
    files = {
        START: (STATIC / "viser" / START).read_bytes(),
        MODULE: unpacked[style_length:],
        STYLES: unpacked[:style_length],
        DECODER: gzip.decompress(from_base88(bootstrap["decoder"].replace("\\\\", "\\"))),
    }
    return ViserClient(page[: bootstrap.start()], page[bootstrap.end() :], files, version_of(files))


def viser_file(request: Request) -> Response:
    """GET /viser/VERSION/NAME."""
    client, name = load_viser(), request.path_params["name"]
    if request.path_params["version"] != client.version or name not in client.files:
        return PlainTextResponse("There is no such file; reload the page.", status_code=404)
    media_type = WASM if name == DECODER else media_type_of(name)
    return compressed(request, client.files[name], media_type=media_type, cache_control=FOR_EVER)


def from_base88(text: str) -> bytes:
    """Five digits make four bytes, most significant first; a shorter last group one byte less than digits."""
    digit_of = np.zeros(128, np.int64)
    digit_of[np.frombuffer(_DIGITS.encode(), np.uint8)] = np.arange(len(_DIGITS))
    digits = digit_of[np.frombuffer(text.encode(), np.uint8)]
    whole = len(digits) // 5 * 5
    words = digits[:whole].reshape(-1, 5) @ 88 ** np.arange(4, -1, -1)
    rest = digits[whole:]
    tail = int(sum(int(d) * 88**i for i, d in enumerate(rest[::-1])))
    return words.astype(">u4").tobytes() + tail.to_bytes(max(len(rest) - 1, 0), "big")
