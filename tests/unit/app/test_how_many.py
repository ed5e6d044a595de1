"""Numbers before what they count."""

from __future__ import annotations

from fairyring.app.how_many import how_many


def test_of_one_thing_alone_there_is_no_plural() -> None:
    assert [how_many(count, "image") for count in (0, 1, 2)] == ["0 images", "1 image", "2 images"]
