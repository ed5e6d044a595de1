"""A line between browser and server that counts what passes over it, and may be slow."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

CHUNK = 16 * 1024
REQUEST = b" HTTP/1.1\r\n"


@dataclass
class Line:
    """Forwards connections from ``listening`` to a port of this machine."""

    listening: socket.socket
    port: int
    bytes_a_second: float
    round_trip_s: float
    """On top of what the server takes to answer."""
    down: int = 0
    """Bytes that came to the browser."""
    requests: int = 0
    _free_at: float = 0.0
    _lock: threading.Lock = field(default_factory=threading.Lock)

    @property
    def url(self) -> str:
        """Where the browser goes."""
        return f"http://127.0.0.1:{self.listening.getsockname()[1]}"

    def reset(self) -> None:
        """Counts anew."""
        self.down = self.requests = 0

    def run(self) -> None:
        """Until ``listening`` is closed."""
        with suppress(OSError):
            while True:
                browser, _ = self.listening.accept()
                server = socket.create_connection(("127.0.0.1", self.port))
                for carry, ends in ((self._ask, (browser, server)), (self._answer, (server, browser))):
                    threading.Thread(target=_pump, args=(*ends, carry), daemon=True).start()

    def _ask(self, chunk: bytes) -> None:
        with self._lock:
            self.requests += chunk.count(REQUEST)
        time.sleep(self.round_trip_s)

    def _answer(self, chunk: bytes) -> None:
        with self._lock:
            self.down += len(chunk)
            # All connections share the line: this chunk is through when those before it are.
            now = time.monotonic()
            self._free_at = max(self._free_at, now) + len(chunk) / self.bytes_a_second
            wait = self._free_at - now
        time.sleep(wait)


def _pump(source: socket.socket, target: socket.socket, carry: Callable[[bytes], None]) -> None:
    """Hands on what comes from ``source``; at its end, or when either is gone, both are closed."""
    with source, target, suppress(OSError):
        while chunk := source.recv(CHUNK):
            carry(chunk)
            target.sendall(chunk)


@contextmanager
def line_to(port: int, *, megabits: float, round_trip_ms: float) -> Iterator[Line]:
    """A line to a server on this machine, ``megabits`` a second wide."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        line = Line(listening, port, megabits * 1e6 / 8, round_trip_ms / 1000)
        threading.Thread(target=line.run, daemon=True).start()
        yield line
        listening.shutdown(socket.SHUT_RDWR)
