"""The messages as the browser types them are those the server takes and sends."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import msgspec
import pytest

from fairyring.app import protocol as messages
from fairyring.model.geometry.shapes import Circle, Ellipse, Fit, Polygon
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage import records
from fairyring.storage.cap_groups import Group

MESSAGES = Path(__file__).parents[3] / "static" / "editor" / "messages"
SOURCE = "\n".join(file.read_text(encoding="utf-8") for file in sorted(MESSAGES.glob("*.js")))
STRUCTS = (
    records.Image,
    ToldArc,
    records.Cap,
    records.Annotation,
    records.Prediction,
    records.Run,
    records.Edit,
    records.ImageContents,
    *get_args(records.Outcome),
    Circle,
    Ellipse,
    Polygon,
    Fit,
    messages.Arc,
    Group,
    *get_args(messages.Incoming),
    *get_args(messages.Outgoing),
)


def typed() -> dict[str, dict[str, str]]:
    """Name → property → type, of every object typedef."""
    blocks = re.findall(r"@typedef \{Object\} (\w+)(.*?)\*/", SOURCE, re.DOTALL)
    properties = re.compile(r"@property \{(.+?)\} \[?(\w+)\]?$", re.MULTILINE)
    return {name: {field: kind for kind, field in properties.findall(body)} for name, body in blocks}


@pytest.mark.parametrize("struct", STRUCTS, ids=lambda struct: struct.__name__)
def test_the_browser_knows_every_field_and_no_other(struct: type[msgspec.Struct]) -> None:
    properties = typed()[struct.__name__]
    config = struct.__struct_config__
    fields = set(struct.__struct_encode_fields__)
    if config.tag is not None:
        assert properties[str(config.tag_field)] == f'"{config.tag}"'
        fields.add(str(config.tag_field))
    assert set(properties) == fields


def test_the_unions_of_messages_are_the_same() -> None:
    for union, name in ((messages.Incoming, "ToServer"), (messages.Outgoing, "FromServer")):
        written = re.search(rf"@typedef \{{([^}}]+)\}} {name} ", SOURCE)
        assert written is not None
        assert set(written[1].split(" | ")) == {struct.__name__ for struct in get_args(union)}
