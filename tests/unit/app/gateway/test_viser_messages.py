"""What passes from a browser to viser."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fairyring.app.gateway.viser_messages import LARGEST, may_pass
from tests.support.tab import CAMERA


def packed(**fields: Any) -> bytes:
    return msgspec.msgpack.encode(fields)


def test_a_message_about_the_camera_passes() -> None:
    assert may_pass(packed(**CAMERA))
    assert may_pass(packed(**CAMERA | {"near": 1, "position": [0, 1, 2]}))


@pytest.mark.parametrize("value", [True, 3, 0.25, "bed_1", "", None])
def test_the_new_value_of_a_control_passes(value: object) -> None:
    assert may_pass(packed(type="GuiUpdateMessage", uuid="a", updates={"value": value}))


@pytest.mark.parametrize(
    "message",
    [
        {"type": "ShareUrlRequest"},
        {"type": "ShareUrlDisconnect"},
        {"type": "GuiFormDirtyMessage", "uuid": "x" * 2**20},
        {"type": "GuiFormDirtyMessage", "uuid": "a"},
        {"type": "GuiFormSubmitMessage", "uuid": "a"},
        {"type": "FileTransferStartUpload", "source_component_uuid": "a", "size_bytes": 2**40},
        {"type": "FileTransferPart", "content": b"x" * 100},
        {"type": "RunJavascriptMessage", "source": "alert(1)"},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"visible": False}},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": "x", "content": "<b>"}},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": ["x"]}},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": "x" * 2001}},
        {"type": "GuiUpdateMessage", "uuid": "a" * 101, "updates": {"value": 1}},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": 1}, "more": 1},
        CAMERA | {"wxyz": [1.0] * 5},
        {},
    ],
)
def test_no_other_message_passes(message: dict[str, Any]) -> None:
    assert not may_pass(packed(**message))


def test_a_large_frame_is_not_even_read() -> None:
    assert not may_pass(b"\xc4" * (LARGEST + 1))


@given(st.binary(max_size=200) | st.integers(1, 5000).map(lambda deep: b"\x91" * deep))
def test_arbitrary_bytes_neither_pass_nor_raise(frame: bytes) -> None:
    assert not may_pass(frame)
