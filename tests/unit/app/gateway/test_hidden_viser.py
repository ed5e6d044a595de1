"""viser behind the gateway, as a foreign page and another process on the machine meet it."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator

import httpx
import msgspec
import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from fairyring.app.gateway.hidden_viser import HEADER, Upstream, start_viser, stop_viser
from tests.support.tab import SUBPROTOCOL, Panel, open_socket

DIRTY = {"type": "GuiFormDirtyMessage", "uuid": "x" * 20_000}
UPLOAD = {
    "type": "FileTransferPart",
    "source_component_uuid": "a",
    "transfer_uuid": "b",
    "content": b"x" * 4000,
}
SHARE = {"type": "ShareUrlRequest"}


@pytest.fixture(scope="module")
def upstream() -> Iterator[Upstream]:
    hidden = Upstream()
    panels = start_viser(hidden, label="beds")
    yield hidden
    stop_viser(panels)


@pytest.mark.parametrize("headers", [{}, {HEADER: ""}, {HEADER: "guess"}, {HEADER: "gue\xdfs"}])
def test_nobody_reaches_viser_without_the_secret(upstream: Upstream, headers: dict[str, str]) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        connect(
            f"ws://127.0.0.1:{upstream.port}/",
            subprotocols=[SUBPROTOCOL],
            additional_headers=headers,
            origin="http://evil.example",
            proxy=None,
        )
    assert httpx.get(f"http://127.0.0.1:{upstream.port}/", headers={}).status_code == 403


def test_a_raw_socket_is_refused_before_the_handshake(upstream: Upstream) -> None:
    lines = ["GET / HTTP/1.1", "Host: localhost", "Upgrade: websocket", "Connection: Upgrade"]
    lines += ["Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Version: 13"]
    with socket.create_connection(("127.0.0.1", upstream.port)) as raw:
        raw.sendall("\r\n".join([*lines, "", ""]).encode())
        assert raw.recv(100).startswith(b"HTTP/1.1 403")


def test_with_the_secret_it_answers(upstream: Upstream) -> None:
    with connect(
        f"ws://127.0.0.1:{upstream.port}/",
        subprotocols=[SUBPROTOCOL],
        additional_headers=upstream.headers,
        proxy=None,
    ) as found:
        assert found.subprotocol == SUBPROTOCOL


def test_the_secret_is_in_nothing_that_is_printed(upstream: Upstream) -> None:
    assert upstream.secret not in repr(upstream)


def test_other_servers_of_websockets_are_started_as_ever(upstream: Upstream) -> None:
    assert upstream.port
    assert viser.infra._infra.websockets.asyncio.server.serve.__module__ == "websockets.asyncio.server"


@pytest.mark.parametrize("message", [DIRTY, UPLOAD, SHARE], ids=["form", "upload", "tunnel"])
def test_what_no_control_says_goes_no_further_than_the_relay(
    shared_port: int, message: dict[str, object]
) -> None:
    ada, bob = Panel(shared_port, name="Ada"), Panel(shared_port, name="Bob")
    assert ada.token
    assert bob.token
    before = len(bob.messages)
    for _ in range(3):
        ada.socket.send(msgspec.msgpack.encode(message))
    ada.socket.send("a text")
    time.sleep(0.3)
    kinds = {told["type"] for told in bob.messages[before:] + ada.messages}
    assert not kinds & {"GuiFormDirtyMessage", "ShareUrlUpdated", "FileTransferPartAck"}
    # The tab itself is not cut off for it.
    assert ada.closed is None
    for panel in (ada, bob):
        panel.socket.close()


@pytest.mark.parametrize("origin", ["http://evil.example", None])
def test_a_foreign_page_reaches_no_panel(shared_port: int, origin: str | None) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        open_socket(shared_port, "/", origin=origin, subprotocols=[SUBPROTOCOL])
