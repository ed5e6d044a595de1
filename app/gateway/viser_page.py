"""viser's page, with the editor's module and styles added and the strictest policy it can live with.

viser ships its client as one HTML file: a small inline script unpacks a stylesheet and a module
(base 88, zstd) and adds them to the page inline. Their hashes go into the Content-Security-Policy,
so that no other inline script or event handler can ever run, whatever ends up in the panel's HTML.
"""

from __future__ import annotations

import base64
import hashlib
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import viser
import zstandard
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from fairyring.app.gateway.access import COMING_BACK
from fairyring.app.gateway.login import ask_for_name, name_of
from fairyring.model.errors import FairyringError

HEAD = """
    <title>Fairyring</title>
    <link rel="icon" type="image/svg+xml" href="/static/icon.svg">
    <link rel="stylesheet" href="/static/style.css">
    <link rel="stylesheet" href="/static/panel.css">
    <link rel="stylesheet" href="/static/overview.css">
    <script type="module" src="/static/editor/main.js"></script>
  </head>"""

_DIGITS = "!#$%()*+,-./0123456789:;=?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_abcdefghijklmnopqrstuvwxyz{|}~"
_BOOTSTRAP = re.compile(
    r'<script data-p="(?P<packed>[^"]*)" data-ss="(?P<style>\d+)" data-cs="(?P<code>\d+)">'
    r"(?P<script>.*?)</script>",
    re.DOTALL,
)


@dataclass(frozen=True)
class Shell:
    """The page and the policy it is sent with."""

    html: str
    policy: str


async def shell_page(request: Request) -> Response:
    """GET /: the editor, or the question for a name while the cookie is missing."""
    if request.url.query:
        # viser's client takes the address of another server from here; nobody may be led to one.
        return RedirectResponse("/")
    if name_of(request) is None:
        if request.headers.get("sec-fetch-site") == "cross-site":
            # A strict cookie is held back when a link elsewhere leads here; asked again from here, it comes.
            return HTMLResponse(COMING_BACK, headers={"Cache-Control": "no-store"})
        return ask_for_name()
    shell = load_shell()
    headers = {"Cache-Control": "no-store", "Content-Security-Policy": shell.policy}
    return HTMLResponse(shell.html, headers=headers)


@cache
def load_shell() -> Shell:
    """viser's index.html with the editor's module, styles and policy added.

    Raises FairyringError where the installed viser's page is not built as this version expects.
    """
    index = Path(viser.__file__).parent / "client" / "build" / "index.html"
    page = index.read_text(encoding="utf-8")
    bootstrap = _BOOTSTRAP.search(page)
    if bootstrap is None or "</head>" not in page:
        raise FairyringError(f"{index} is not the page of viser 1.1.1; install viser==1.1.1 again.")
    code = _unpack_module(bootstrap)
    html = re.sub(
        r"<title>.*?</title>|<link\s+rel=\"icon\"[^>]*>", "", page[: bootstrap.start()], flags=re.DOTALL
    )
    html += page[bootstrap.start() :].replace("</head>", HEAD, 1)
    return Shell(html=html, policy=_policy(bootstrap["script"].encode(), code))


def _unpack_module(bootstrap: re.Match[str]) -> bytes:
    packed, style_length = _from_base88(bootstrap["packed"]), int(bootstrap["style"])
    unpacked = zstandard.decompress(packed, max_output_size=style_length + int(bootstrap["code"]))
    return unpacked[style_length:]


def _from_base88(text: str) -> bytes:
    """Decodes base 88: n digits make n - 1 bytes, most significant first, in groups of five digits."""
    digit_of = np.zeros(128, np.int64)
    digit_of[np.frombuffer(_DIGITS.encode(), np.uint8)] = np.arange(len(_DIGITS))
    digits = digit_of[np.frombuffer(text.encode(), np.uint8)]
    whole = len(digits) // 5 * 5
    words = digits[:whole].reshape(-1, 5) @ 88 ** np.arange(4, -1, -1)
    rest = digits[whole:]
    tail = int(sum(int(d) * 88**i for i, d in enumerate(rest[::-1])))
    return words.astype(">u4").tobytes() + tail.to_bytes(max(len(rest) - 1, 0), "big")


def _policy(*scripts: bytes) -> str:
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'" for script in scripts
    )
    return "; ".join(
        (
            "default-src 'none'",
            # viser's WebAssembly names its functions by evaluating a string.
            f"script-src 'self' 'unsafe-eval' {hashes}",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self' data:",
            "connect-src 'self' data: blob:",
            "worker-src 'self' blob: data:",
            "form-action 'self'",
            "base-uri 'none'",
            "frame-ancestors 'none'",
        )
    )
