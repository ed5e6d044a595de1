"""WebSockets that take little until they are trusted with more, and large frames only one at a time.

uvicorn has one limit for all frames of all sockets, and keeps what has come of a frame until all of it has.
Anybody who can open a socket could have the server hold as many megabytes as they open sockets.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any, ClassVar

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.http11 import Request

AT_FIRST = 32 * 2**10
"""Most bytes of a message until a socket is trusted with more."""
LARGE = 2**20
"""A message of more bytes than this waits for its turn."""
LARGE_WITHIN_S = 30.0
"""How long a large message may take to come, when it is its turn."""
EXTENSION = "fairyring.trust"
"""Key of the scope's extension: a function that raises the socket's limit to so many bytes."""


class LargeMessages:
    """Whose turn it is to send a large message, from its first megabyte until it was dealt with."""

    def __init__(self) -> None:
        self._now: BoundedSocket | None = None
        self._waiting: deque[BoundedSocket] = deque()

    def is_turn_of(self, socket: BoundedSocket) -> bool:
        """Whether it is this socket's turn; if not, it will be told."""
        if self._now is None:
            self._now = socket
            socket.turn_begins()
        elif self._now is not socket and socket not in self._waiting:
            self._waiting.append(socket)
        return self._now is socket

    def leave(self, socket: BoundedSocket) -> None:
        """The socket has no large message, or none any longer."""
        if socket in self._waiting:
            self._waiting.remove(socket)
        if self._now is socket:
            self._now = self._waiting.popleft() if self._waiting else None
            if self._now is not None:
                self._now.turn_begins()


class BoundedSocket(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket, with the limits of this module."""

    large: ClassVar[LargeMessages]
    """Shared by all sockets of a server."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.conn.max_message_size = AT_FIRST
        self._deadline: asyncio.TimerHandle | None = None
        self._dealing_with_large = False

    def handle_connect(self, event: Request) -> None:
        """Lets the application trust this socket."""
        super().handle_connect(event)
        # There is none where the handshake made no sense.
        scope: dict[str, Any] = vars(self).get("scope", {})
        scope.setdefault("extensions", {})[EXTENSION] = self._trust

    def data_received(self, data: bytes) -> None:
        """Takes no more of a large message before it is its turn."""
        super().data_received(data)
        held = len(self.conn.reader.buffer) + (self.conn.current_size or 0)
        if held > LARGE and not self.transport.is_closing() and not self.large.is_turn_of(self):
            self.transport.pause_reading()

    def turn_begins(self) -> None:
        """The large message may come, but not for ever."""
        self._deadline = self.loop.call_later(LARGE_WITHIN_S, self.transport.abort)
        if not self.read_paused:
            self.transport.resume_reading()

    async def receive(self) -> Any:
        """The next message; asked for it, the one before was dealt with."""
        if self._dealing_with_large:
            self._dealing_with_large = False
            self.large.leave(self)
        message = await super().receive()
        if self._deadline is not None and message["type"] == "websocket.receive":
            self._deadline.cancel()
            self._deadline, self._dealing_with_large = None, True
        return message

    def connection_lost(self, exc: Exception | None) -> None:
        """Leaves the turn to others."""
        if self._deadline is not None:
            self._deadline.cancel()
        self.large.leave(self)
        super().connection_lost(exc)

    def _trust(self, most: int) -> None:
        self.conn.max_message_size = most


def sockets_of_one_server() -> type[BoundedSocket]:
    """The class of the sockets of one server."""

    class SocketOfOneServer(BoundedSocket):
        large = LargeMessages()

    return SocketOfOneServer


def trust(scope: Any, *, most: int) -> None:
    """Lets the socket of an ASGI scope send messages of so many bytes."""
    raise_limit: Callable[[int], None] | None = (scope.get("extensions") or {}).get(EXTENSION)
    if raise_limit is not None:
        raise_limit(most)
