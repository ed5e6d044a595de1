"""The status of an image is a sign and a word; one that was given back does not look like one never begun."""

import pytest
from msgspec.structs import replace

from fairyring.app.panels.status import status_badge
from fairyring.storage.records import Image, Says, Status

IMAGE = Image(id=1, file_name="bed.png", path="bed.png", width=10, height=10, sha256="")


@pytest.mark.parametrize(
    ("status", "said", "words"),
    [
        ("new", None, "○ to do"),
        ("new", "rejected", "✗ rejected"),
        ("new", "sent_back", "↩ sent back"),
        ("annotated", "sent_back", "◐ annotated"),
        ("approved", None, "✓ approved"),
    ],
)
def test_the_badge_says_what_was_last_said(status: Status, said: Says | None, words: str) -> None:
    assert f">{words}<" in status_badge(replace(IMAGE, status=status), said).html
