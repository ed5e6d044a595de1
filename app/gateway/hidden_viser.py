"""viser on a port of 127.0.0.1 where it answers nobody but the gateway.

Every page in the browser and every process on the machine can reach such a port, and viser asks nobody who
they are. So each request must carry a secret that only this process knows, checked before the handshake.
"""

from __future__ import annotations

import contextlib
import http
import http.client
import io
import secrets
import socket
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

import viser
import viser._messages
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from fairyring.model.errors import FairyringError

HEADER = "X-Fairyring-Secret"
"""Width of the panel, pixels."""
UNUSED = (viser._messages.ShareUrlRequest, viser._messages.ShareUrlDisconnect)
"""Messages that would make viser open a public tunnel; they are disabled."""

STARTING = "serve"
"""The function of ``websockets.asyncio.server`` by which viser starts its server."""

Result = TypeVar("Result")


class ViserError(FairyringError):
    """viser cannot be started, or not in a way that hides it."""


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@dataclass(frozen=True)
class Upstream:
    """Where viser listens, and the secret it asks for."""

    port: int = field(default_factory=_free_port)
    secret: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)

    @property
    def headers(self) -> dict[str, str]:
        """Headers that every request to viser must carry."""
        return {HEADER: self.secret}


def start_viser(upstream: Upstream, *, label: str) -> viser.ViserServer:
    """Starts viser, without a word on stdout.

    Raises ViserError where it ends up on another port, or answers without the secret.
    """
    # A tab may close at any moment; what is still on its way to it is of no use to anybody.
    warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")
    with _asking_for(upstream.secret):
        panels = quietly(lambda: viser.ViserServer("127.0.0.1", upstream.port, label=label, verbose=False))
    try:
        if panels.get_port() != upstream.port:
            raise ViserError("The port found for the panels was taken meanwhile; start again.")
        if _status_without_secret(upstream.port) != http.HTTPStatus.FORBIDDEN:
            raise ViserError("viser answers anybody on this machine; install viser==1.1.1 again.")
        for message in UNUSED:
            panels._websock_server.unregister_handler(message)
    except Exception:
        stop_viser(panels)
        raise
    panels.scene.world_axes.visible = False
    panels.gui.configure_theme(show_logo=False, show_share_button=False)
    panels.gui.main_panel.dock_right()
    return panels


def stop_viser(panels: viser.ViserServer) -> None:
    """Stops viser, without a word on stdout."""
    quietly(panels.stop)


@contextmanager
def _asking_for(secret: str) -> Iterator[None]:
    """Makes a server that ``websockets`` starts within the block refuse every request without the secret.

    viser hands its server no check of its own, so the function by which it starts one is put in its place.
    """
    serve = getattr(websockets.asyncio.server, STARTING)

    def check(connection: ServerConnection, request: Request) -> Response | None:
        given = request.headers.get_all(HEADER)
        if len(given) == 1 and secrets.compare_digest(
            given[0].encode(errors="surrogateescape"), secret.encode()
        ):
            return None
        return connection.respond(http.HTTPStatus.FORBIDDEN, "Not here.\n")

    def serve_checked(*arguments: Any, **options: Any) -> Any:
        return serve(*arguments, **(options | {"process_request": check}))

    setattr(websockets.asyncio.server, STARTING, serve_checked)
    try:
        yield
    finally:
        setattr(websockets.asyncio.server, STARTING, serve)


def _status_without_secret(port: int) -> int:
    answer = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    with contextlib.closing(answer):
        answer.request("GET", "/")
        return answer.getresponse().status


def quietly(call: Callable[[], Result]) -> Result:
    """Calls a function and drops what it prints."""
    with contextlib.redirect_stdout(io.StringIO()):
        return call()
