"""A browser tab without a browser: speaks viser's protocol and the editor's, as the page does."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar
from urllib.parse import quote

import msgspec
import zstandard
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from fairyring.app.bench.visitor import CAMERA, SUBPROTOCOL, TOKEN
from fairyring.app.protocol import Edits, Hello, Incoming, Outcomes, Outgoing
from fairyring.storage.records import Cap, Edit

DEADLINE_S = 10.0
Kind = TypeVar("Kind")
SQUARE = [[20.0, 20.0, 60.0, 20.0, 60.0, 60.0, 20.0, 60.0]]


def until(condition: Callable[[], Any], what: str = "", *, within_s: float = DEADLINE_S) -> Any:
    """Waits until the condition holds, and returns what made it so."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        if found := condition():
            return found
        time.sleep(0.01)
    raise AssertionError(f"waited in vain for {what or condition}")


class Panel:
    """viser's side of a tab: collects the messages that draw the panel."""

    def __init__(self, port: int, *, name: str) -> None:
        self.socket = open_socket(port, "/", name=name, subprotocols=[SUBPROTOCOL])
        self.messages: list[dict[str, Any]] = []
        self.closed: ConnectionClosed | None = None
        self.socket.send(msgspec.msgpack.encode(CAMERA))
        self.thread = threading.Thread(target=self._collect, daemon=True)
        self.thread.start()

    def _collect(self) -> None:
        try:
            for frame in self.socket:
                assert isinstance(frame, bytes)
                size = int.from_bytes(frame[8:16], "little")
                unpacked = zstandard.decompress(
                    frame[16 : 16 + size], max_output_size=int.from_bytes(frame[:8], "little")
                )
                self.messages.extend(msgspec.msgpack.decode(unpacked)["messages"])
        except ConnectionClosed as closed:
            self.closed = closed

    @property
    def html(self) -> str:
        """Everything the panel's HTML elements hold now."""
        content: dict[str, str] = {}
        for message in list(self.messages):
            if message["type"] == "GuiHtmlMessage":
                content[message["uuid"]] = message["props"]["content"]
            elif message["type"] == "GuiUpdateMessage" and "content" in message["updates"]:
                content[message["uuid"]] = message["updates"]["content"]
        return "\n".join(content.values())

    @property
    def token(self) -> str:
        # A busy machine takes its time; a server that dies meanwhile is not waited for.
        found = until(lambda: TOKEN.search(self.html) or self.closed, "a token", within_s=6 * DEADLINE_S)
        if found is self.closed:
            raise found
        return found.group(1)

    def uuid_of(self, label: str) -> str:
        """The input of this label."""
        return until(
            lambda: next(
                (m["uuid"] for m in list(self.messages) if m.get("props", {}).get("label") == label), None
            ),
            label,
        )

    def set(self, label: str, value: object) -> None:
        """What a person does to an input."""
        update = {"type": "GuiUpdateMessage", "uuid": self.uuid_of(label), "updates": {"value": value}}
        self.socket.send(msgspec.msgpack.encode(update))


class Tab:
    """A tab whose editor has said hello. Use it in a ``with``."""

    def __init__(self, port: int, *, name: str = "Ada", image: int | None = None) -> None:
        self.panel = Panel(port, name=name)
        self.editor = open_socket(port, "/editor", name=name)
        self.received: list[Outgoing] = []
        self.send(Hello(token=self.panel.token, image=image))

    def __enter__(self) -> Tab:
        return self

    def __exit__(self, *_: object) -> None:
        for socket in (self.editor, self.panel.socket):
            with suppress(ConnectionClosed):
                socket.close()

    def send(self, message: Incoming) -> None:
        self.editor.send(msgspec.json.encode(message).decode())

    def expect(
        self,
        kind: type[Kind],
        where: Callable[[Kind], bool] = lambda _: True,
        *,
        within_s: float = DEADLINE_S,
    ) -> Kind:
        """The next message of a kind; what comes before it is kept in ``received``."""
        deadline = time.monotonic() + within_s
        while True:
            message = msgspec.json.decode(self.editor.recv(deadline - time.monotonic()), type=Outgoing)
            self.received.append(message)
            if isinstance(message, kind) and where(message):
                return message

    def nothing_more(self, kind: type[Kind], *, within_s: float = 0.3) -> bool:
        """Whether no message of this kind comes for a while."""
        try:
            while True:
                message = msgspec.json.decode(self.editor.recv(within_s), type=Outgoing)
                if isinstance(message, kind):
                    return False
        except TimeoutError:
            return True

    def close_code(self) -> int:
        """Waits until the server closes the editor's socket, and with which code."""
        with suppress(ConnectionClosed):
            while True:
                self.editor.recv(DEADLINE_S)
        return until(lambda: self.editor.close_code, "a close code")

    def edit(self, *edits: Edit) -> Outcomes:
        """Sends a change set and waits for its outcomes."""
        self.send(Edits(edits=list(edits)))
        return self.expect(Outcomes)


def new_cap(image: int, *, uid: str = "cap-1", edit: str = "edit-1", base: int = 0, **cap: Any) -> Edit:
    """An edit that makes, or remakes, a square cap."""
    return Edit(id=edit, annotation=uid, image=image, base=base, cap=Cap(**{"visible": SQUARE, **cap}))


def open_socket(
    port: int, path: str, *, name: str | None = "Ada", origin: str | None = "same", **options: Any
) -> ClientConnection:
    """A WebSocket as a browser opens it from the server's own page, unless told otherwise."""
    headers = {} if name is None else {"Cookie": f"fairyring_name={quote(name)}"}
    host = f"127.0.0.1:{port}"
    return connect(
        f"ws://{host}{path}",
        origin=f"http://{host}" if origin == "same" else origin,
        additional_headers=headers,
        compression=None,
        max_size=None,
        proxy=None,
        **options,
    )
