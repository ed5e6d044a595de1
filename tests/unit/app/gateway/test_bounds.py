"""What the server holds of what is half sent, and for how long."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import closing, suppress

import pytest
from websockets.exceptions import ConnectionClosed

from fairyring.app.gateway import bounded_sockets, timely_requests
from fairyring.app.protocol import Fitted, Notice, Refit, Show, Welcome
from fairyring.storage.records import Cap
from tests.support.tab import SUBPROTOCOL, Tab, open_socket
from tests.unit.app.conftest import circle

A_MEGABYTE = 2**20


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timely_requests, "WHOLE_WITHIN_S", 0.5)
    monkeypatch.setattr(bounded_sockets, "LARGE_WITHIN_S", 1.0)


def large_message(megabytes: float) -> str:
    """A text that no editor sends."""
    return "x" * int(megabytes * A_MEGABYTE)


@pytest.mark.parametrize("path", ["/editor", "/"])
def test_before_it_said_hello_a_socket_may_send_little(shared_port: int, path: str) -> None:
    waiting = open_socket(shared_port, path, subprotocols=[SUBPROTOCOL] if path == "/" else None)
    waiting.send(b"x" * 40_000)
    with suppress(ConnectionClosed):
        while True:
            waiting.recv(5)
    assert waiting.close_code == 1009


def test_the_editor_may_send_much_once_it_has_said_hello(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Welcome)
        tab.send(Refit(seq=1, image=1, annotation="x" * 2 * A_MEGABYTE, cap=Cap(visible=circle(40, 40, 20))))
        assert len(tab.expect(Fitted).annotation) == 2 * A_MEGABYTE


class HalfSent:
    """A large message of which the last byte is missing, sent over the socket of a tab."""

    def __init__(self, tab: Tab, *, megabytes: int) -> None:
        self._editor = tab.editor
        size = megabytes * A_MEGABYTE
        head = bytes([0x81, 0x80 | 127]) + size.to_bytes(8, "big") + bytes(4)
        self.thread = threading.Thread(target=self._send, args=(head + b"x" * (size - 1),), daemon=True)
        self.thread.start()

    def _send(self, frame: bytes) -> None:
        try:
            self._editor.socket.sendall(frame)
        except OSError:
            return

    def end(self) -> None:
        self.thread.join(5)
        self._editor.socket.sendall(b"x")


@pytest.fixture
def two(port: int) -> Iterator[tuple[Tab, Tab]]:
    with Tab(port, image=1) as ada, Tab(port, name="Bob", image=1) as bob:
        ada.expect(Show)
        bob.expect(Show)
        yield ada, bob


def test_one_large_message_comes_in_after_the_other(two: tuple[Tab, Tab]) -> None:
    ada, bob = two
    first = HalfSent(ada, megabytes=12)
    first.thread.join(5)
    assert not first.thread.is_alive()
    second = HalfSent(bob, megabytes=12)
    second.thread.join(1)
    assert second.thread.is_alive()
    first.end()
    assert "cannot read" in ada.expect(Notice).text
    second.end()
    assert "cannot read" in bob.expect(Notice).text


@pytest.mark.usefixtures("quick")
def test_who_does_not_end_a_large_message_keeps_nobody_waiting(two: tuple[Tab, Tab]) -> None:
    ada, bob = two
    HalfSent(ada, megabytes=12).thread.join(5)
    second = HalfSent(bob, megabytes=12)
    second.end()
    assert "cannot read" in bob.expect(Notice).text
    with pytest.raises(ConnectionClosed):
        ada.editor.recv(5)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "sent",
    [
        b"",
        b"GET / HTTP/1.1\r\nHost: localh",
        b"POST /name HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\nname=A",
        b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\nGET /healthz HT",
    ],
    ids=["nothing", "half a head", "half a body", "half a second one"],
)
def test_half_a_request_is_given_up(shared_port: int, sent: bytes) -> None:
    began = time.monotonic()
    with closing(socket.create_connection(("127.0.0.1", shared_port), timeout=10)) as raw:
        raw.sendall(sent)
        with suppress(ConnectionResetError):
            while raw.recv(65536):
                pass
    # The last waits as long as a connection may stay open without a request.
    assert time.monotonic() - began < 8


@pytest.mark.usefixtures("quick")
def test_a_socket_stays_open_for_as_long_as_it_likes(shared_port: int) -> None:
    with Tab(shared_port, image=1) as tab:
        tab.expect(Show)
        time.sleep(1.2)
        tab.send(Refit(seq=1, image=1, annotation="a", cap=Cap(visible=circle(40, 40, 20))))
        assert tab.expect(Fitted).seq == 1
