"""Who may come in on a shared machine: only browsers that were led in by an address which the server printed.

Everybody with an account on this machine can reach the port. So the printed address holds a token; the first
browser to open it gets a cookie and the token is spent, as it may be seen in the browser's history or, where
the server opened the browser, in the list of processes.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from urllib.parse import parse_qs

from starlette.datastructures import Headers
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

KEY_FILE = "access.key"
KEY_BYTES = 32
A_YEAR = 365 * 24 * 3600
ALWAYS_OPEN = frozenset({"/healthz"})
SHUT = (
    "Open the address that fairyring serve printed; it leads in once. A new one stands in its terminal then."
)
COMING_BACK = '<!doctype html><meta http-equiv="refresh" content="0; url=/"><title>Fairyring</title>'


@dataclass(kw_only=True, eq=False)
class Door:
    """The token that leads in now, and the key by which cookies given before are known again."""

    key: bytes = field(repr=False)
    cookie: str
    """Name of the cookie, one a project: all ports of a host share their cookies."""
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24), repr=False)
    used: Callable[[], object] = lambda: None
    """Called when the token was spent and another has taken its place."""

    def spend(self, token: str) -> bool:
        """Whether this is the token; a right one is used up by asking."""
        if not hmac.compare_digest(token.encode(errors="replace"), self.token.encode()):
            return False
        self.token = secrets.token_urlsafe(24)
        self.used()
        return True

    def new_pass(self) -> str:
        """The value of a new cookie."""
        number = secrets.token_urlsafe(16)
        return f"{number}.{self._signature(number)}"

    def knows(self, value: str) -> bool:
        """Whether this door gave the cookie."""
        number, _, signature = value.partition(".")
        return hmac.compare_digest(signature.encode(errors="replace"), self._signature(number).encode())

    def _signature(self, number: str) -> str:
        return hmac.new(self.key, number.encode(errors="replace"), hashlib.sha256).hexdigest()


def door_of(cache: Path, *, project_id: str) -> Door:
    """The door of a project. Its key is kept in ``cache``, so that browsers are known after a restart.

    A key that cannot be kept, as in a project that is read-only, is good until the server stops.
    """
    return Door(key=_kept_key(cache / KEY_FILE), cookie=f"fairyring_pass_{project_id[:12]}")


def _kept_key(file: Path) -> bytes:
    with suppress(OSError):
        if len(key := file.read_bytes()) == KEY_BYTES:
            return key
    key = secrets.token_bytes(KEY_BYTES)
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.unlink(missing_ok=True)
        file.touch(mode=0o600)
        file.write_bytes(key)
    return key


class OnlyWithPass:
    """ASGI middleware: serves nothing but ``/healthz`` to a browser that was not led in."""

    def __init__(self, app: ASGIApp, door: Door) -> None:
        self.app = app
        self.door = door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        kind = scope["type"]
        if kind not in {"http", "websocket"} or scope["path"] in ALWAYS_OPEN or self._is_known(scope):
            await self.app(scope, receive, send)
        elif kind == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": SHUT})
        else:
            await self._answer(scope)(scope, receive, send)

    def _is_known(self, scope: Scope) -> bool:
        jar = SimpleCookie()
        with suppress(CookieError):
            jar.load(Headers(scope=scope).get("cookie", ""))
        given = jar.get(self.door.cookie)
        return given is not None and self.door.knows(given.value)

    def _answer(self, scope: Scope) -> Response:
        """Answers a browser without the cookie: lets it in if it has the token, else refuses."""
        tokens = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        is_page = scope["path"] == "/" and scope["method"] == "GET"
        if is_page and len(tokens) == 1 and self.door.spend(tokens[0]):
            response = RedirectResponse("/", status_code=303)
            response.set_cookie(
                self.door.cookie, self.door.new_pass(), max_age=A_YEAR, httponly=True, samesite="strict"
            )
            return response
        if is_page and not tokens and Headers(scope=scope).get("sec-fetch-site") == "cross-site":
            # A strict cookie is held back when a link elsewhere leads here; asked again from here, it comes.
            return HTMLResponse(COMING_BACK, headers={"Cache-Control": "no-store"})
        return PlainTextResponse(SHUT, status_code=403, headers={"Cache-Control": "no-store"})
