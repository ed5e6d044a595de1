"""What a browser may say to viser: where its camera is, and the new value of a control. Nothing else.

viser itself takes far more: it opens a public tunnel when asked to, keeps what it is told of forms for ever
and sends it to everybody, buffers uploads for controls that have none, and sets any property of a control.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

LARGEST = 16 * 2**10
"""Most bytes of a message; the largest that the panel's controls make is a search text."""

Numbers3 = tuple[float, float, float]
Text = Annotated[str, Meta(max_length=2000)]


class ViewerCameraMessage(Struct, tag_field="type", forbid_unknown_fields=True):
    """The camera; viser counts a browser as connected from the first one on."""

    wxyz: tuple[float, float, float, float]
    position: Numbers3
    fov: float
    near: float
    far: float
    image_height: int | float
    image_width: int | float
    look_at: Numbers3
    up_direction: Numbers3


class GuiUpdateMessage(Struct, tag_field="type", forbid_unknown_fields=True):
    """A control was used."""

    uuid: Annotated[str, Meta(max_length=100)]
    updates: dict[Literal["value"], bool | int | float | Text | None]


_messages = msgspec.msgpack.Decoder(ViewerCameraMessage | GuiUpdateMessage)


def may_pass(frame: bytes) -> bool:
    """Whether viser may be shown a frame that a browser sent."""
    if len(frame) > LARGEST:
        return False
    try:
        _messages.decode(frame)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return False
    return True
