"""A tab without a browser, of which one process can have dozens: speaks viser's protocol and the editor's."""

from __future__ import annotations

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, TypeVar
from urllib.parse import quote

import msgspec
import zstandard
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin

from fairyring.app.protocol import Hello, Incoming, Outgoing

SUBPROTOCOL = "viser-v1.1.1"
TOKEN = re.compile(r'id="fairyring-tab" data-token="([^"]+)"')
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 1.0],
    "fov": 1.0,
    "near": 0.1,
    "far": 10.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}
"""The message by which viser's page says that it is there."""
PATIENCE_S = 60.0
Kind = TypeVar("Kind")

_outgoing = msgspec.json.Decoder(Outgoing)


@dataclass(frozen=True)
class Visitor:
    """Somebody whose editor has said hello."""

    editor: ClientConnection

    async def send(self, message: Incoming) -> None:
        """Sends one message, as the editor does."""
        await self.editor.send(msgspec.json.encode(message).decode())

    async def expect(self, kind: type[Kind]) -> Kind:
        """The next message of a kind; what comes before it is passed over. TimeoutError if none comes."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                message = _outgoing.decode(await self.editor.recv())
                if isinstance(message, kind):
                    return message


@asynccontextmanager
async def visitor(port: int, *, name: str, image: int) -> AsyncIterator[Visitor]:
    """Somebody who looks at an image, for as long as the block lasts."""
    async with _socket(port, "/", name=name, subprotocols=[SUBPROTOCOL]) as panel:
        await panel.send(msgspec.msgpack.encode(CAMERA))
        token = await _token(panel)
        listening = asyncio.create_task(_listen(panel))
        async with _socket(port, "/editor", name=name) as editor:
            found = Visitor(editor)
            await found.send(Hello(token=token, image=image))
            yield found
        listening.cancel()


def _socket(port: int, path: str, *, name: str, **options: Any) -> connect:
    return connect(
        f"ws://127.0.0.1:{port}{path}",
        origin=Origin(f"http://127.0.0.1:{port}"),
        additional_headers={"Cookie": f"fairyring_name={quote(name)}"},
        compression=None,
        max_size=None,
        ping_interval=None,
        proxy=None,
        **options,
    )


async def _token(panel: ClientConnection) -> str:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            found = TOKEN.search(_unpacked(await panel.recv(decode=False)))
            if found:
                return found[1]


def _unpacked(frame: bytes) -> str:
    """The text in the messages of a frame of viser's."""
    size, length = (int.from_bytes(frame[start : start + 8], "little") for start in (8, 0))
    return zstandard.decompress(frame[16 : 16 + size], max_output_size=length).decode(errors="replace")


async def _listen(panel: ClientConnection) -> None:
    async for _ in panel:
        pass
