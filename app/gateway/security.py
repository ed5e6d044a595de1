"""Which requests are answered at all: only those from pages that this very server sent.

A page elsewhere on the web can make a browser send requests and open sockets to 127.0.0.1, and by
DNS rebinding even read the answers. So every request must name a loopback host, and whatever can
change something (and every socket) must come from a page of exactly that host and port.
"""

from __future__ import annotations

from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})

WRONG_HOST = "This address is not served here: open Fairyring as http://localhost with its port."
WRONG_ORIGIN = "This request does not come from a page of this server, so it is refused."

SECURITY_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
}
DEFAULT_POLICY = (
    "default-src 'none'; style-src 'self'; img-src 'self'; form-action 'self'; frame-ancestors 'none'"
)


def is_loopback(host: str) -> bool:
    """Whether a Host header (with or without a port) names this machine itself."""
    try:
        parts = urlsplit(f"//{host}")
        return parts.username is None and parts.path == "" and parts.hostname in LOOPBACK
    except ValueError:
        return False


def is_same_origin(origin: str | None, host: str) -> bool:
    """Whether a page of ``origin`` was sent by the server that is addressed as ``host``.

    The port is compared with the one in the Host header, not with the one listened on, so that a
    port forwarded by ssh works too; another server on this machine still has another origin.
    """
    return origin in {f"http://{host}", f"https://{host}"}


class Guard:
    """ASGI middleware: refuses foreign hosts and origins, adds the security headers."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in {"http", "websocket"}:
            await self.app(scope, receive, send)
            return
        send = _with_security_headers(send)
        if scope["type"] == "websocket":
            send = _refusing_in_http(send, scope, receive)
        refusal = _refusal(scope)
        if refusal is None:
            await self.app(scope, receive, send)
        else:
            await PlainTextResponse(refusal, status_code=403)(scope, receive, send)


def _refusal(scope: Scope) -> str | None:
    headers = Headers(scope=scope)
    host = headers.get("host", "")
    if not is_loopback(host):
        return WRONG_HOST
    changes_something = scope["type"] == "websocket" or scope["method"] not in SAFE_METHODS
    if changes_something and not is_same_origin(headers.get("origin"), host):
        return WRONG_ORIGIN
    return None


def _with_security_headers(send: Send) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] in {"http.response.start", "websocket.http.response.start"}:
            headers = MutableHeaders(scope=message)
            for name, value in SECURITY_HEADERS.items():
                headers.setdefault(name, value)
            headers.setdefault("Content-Security-Policy", DEFAULT_POLICY)
        await send(message)

    return send_with_headers


def _refusing_in_http(send: Send, scope: Scope, receive: Receive) -> Send:
    """Answers the handshake of a socket that is closed before it was accepted as any other request."""
    accepted = False

    async def send_or_refuse(message: Message) -> None:
        nonlocal accepted
        accepted = accepted or message["type"] == "websocket.accept"
        if message["type"] == "websocket.close" and not accepted:
            reason = message.get("reason") or "There is no such socket."
            await PlainTextResponse(reason, status_code=403)(scope, receive, send)
        else:
            await send(message)

    return send_or_refuse
