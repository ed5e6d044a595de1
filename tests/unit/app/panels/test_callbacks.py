"""Redrawing of a panel's parts: at once after what a person did, collected after what others did."""

from __future__ import annotations

import asyncio

import pytest

from fairyring.app.panels import callbacks
from fairyring.app.panels.callbacks import Redrawing


@pytest.fixture(autouse=True)
def short_delays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(callbacks, "REDRAW_AFTER_S", 0.01)
    monkeypatch.setattr(callbacks, "FOLLOW_AFTER_S", 0.2)


def drawn_after(seconds: float, *asked: tuple[str, str]) -> list[str]:
    """The parts drawn so long after they were asked for: each ``(part, "now" or "soon")``."""
    drawn: list[str] = []

    async def draw(part: str) -> None:
        drawn.append(part)

    async def work() -> None:
        redrawing = Redrawing({part: lambda part=part: draw(part) for part in ("cap", "images")})
        for part, when in asked:
            (redrawing.ask if when == "now" else redrawing.ask_later)((part,))
            await asyncio.sleep(0)
        await asyncio.sleep(seconds)

    asyncio.run(work())
    return drawn


def test_what_a_person_did_is_drawn_at_once() -> None:
    assert drawn_after(0.1, ("cap", "now"), ("images", "soon")) == ["cap"]


def test_what_many_others_did_is_drawn_once_for_all_of_them() -> None:
    assert drawn_after(0.5, *[("images", "soon"), ("cap", "soon")] * 20) == ["cap", "images"]


def test_what_comes_after_a_collected_redraw_is_drawn_by_the_next() -> None:
    drawn: list[float] = []

    async def draw() -> None:
        drawn.append(asyncio.get_running_loop().time())

    async def work() -> None:
        redrawing = Redrawing({"images": draw})
        redrawing.ask_later(("images",))
        await asyncio.sleep(0.3)
        redrawing.ask_later(("images",))
        await asyncio.sleep(0.4)

    asyncio.run(work())
    assert len(drawn) == 2


def test_parts_that_a_panel_lacks_are_passed_over() -> None:
    assert drawn_after(0.4, ("jobs", "now"), ("review", "soon")) == []
