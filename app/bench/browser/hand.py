"""A hand at mouse and keyboard, which counts what it does and how long a practised person takes for it.

Times of the keystroke-level model: Card, Moran and Newell, "The keystroke-level model for user performance
time with interactive systems", 1980. A line is drawn at the pace of somebody who follows an edge.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

from fairyring.app.bench.browser.tab import Point, Tab

POINT_S, CLICK_S, KEY_S, DECIDE_S = 1.1, 0.2, 0.28, 1.35
"""To bring the pointer to a place; to press and let go a button; to press a key; to make up one's mind."""
TRACE_PX_A_SECOND = 80.0
"""CSS pixels."""
STEP_PX = 4.0
"""While a line is drawn the mouse tells so often where it is, CSS pixels."""


@dataclass
class Inputs:
    """What a person did."""

    points: int = 0
    clicks: int = 0
    keys: int = 0
    presses: int = 0
    """Of keys, those pressed together counted once; a key held for a click or a stroke is part of that."""
    strokes: int = 0
    """Lines drawn with the button held."""
    traced_px: float = 0.0
    """Their length together, CSS pixels."""
    decisions: int = 0

    @property
    def count(self) -> int:
        """How many things a person did: presses, clicks and strokes."""
        return self.presses + self.clicks + self.strokes

    @property
    def seconds(self) -> float:
        """How long a person takes for all of it."""
        return (
            POINT_S * self.points
            + CLICK_S * (self.clicks + self.strokes)
            + KEY_S * self.keys
            + self.traced_px / TRACE_PX_A_SECOND
            + DECIDE_S * self.decisions
        )


class Hand:
    """Moves the pointer to whole CSS pixels, as a mouse does. Places are points of the image."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.done = Inputs()

    def decide(self) -> None:
        """Looks at something and makes up its mind."""
        self.done.decisions += 1

    def press(self, *keys: str) -> None:
        """Presses keys, one after the other; a chord is a press of each of its keys."""
        for key in keys:
            self.done.presses += 1
            self.done.keys += len(key.split("+"))
            self.tab.press(key)

    def point(self, at: Point) -> None:
        """Brings the pointer to a place and lets it rest."""
        self.done.points += 1
        x, y = self._pixel(at)
        self.tab.page.mouse.move(x - 1, y)
        self.tab.page.mouse.move(x, y)

    def click(self, *, key: str | None = None) -> None:
        """Presses the button where the pointer is, and lets it go, with a key held or none."""
        self.done.clicks += 1
        with self._held(key):
            self.tab.page.mouse.down()
            self.tab.page.mouse.up()

    def wheel(self, notches: int) -> None:
        """Turns the wheel towards the photo; a notch takes as long as a key."""
        self.done.presses += notches
        self.done.keys += notches
        for _ in range(notches):
            self.tab.page.mouse.wheel(0, -100)

    def draw(self, line: Sequence[Point], *, key: str | None = None) -> None:
        """Draws a line with the button held, and with a key or none."""
        self.point(line[0])
        self.done.strokes += 1
        mouse = self.tab.page.mouse
        with self._held(key):
            mouse.down()
            for start, end in pairwise(self._seldom([self._pixel(at) for at in line])):
                length = math.dist(start, end)
                self.done.traced_px += length
                mouse.move(*end, steps=max(1, round(length / STEP_PX)))
            mouse.up()

    @contextmanager
    def _held(self, key: str | None) -> Iterator[None]:
        if key is not None:
            self.done.keys += 1
            self.tab.page.keyboard.down(key)
        yield
        if key is not None:
            self.tab.page.keyboard.up(key)

    def _seldom(self, places: Sequence[Point]) -> list[Point]:
        """The first of the places, and each that lies a step from the one before; the last in any case."""
        kept = [places[0]]
        for place in places:
            if math.dist(place, kept[-1]) >= STEP_PX:
                kept.append(place)
        return [*kept, places[-1]]

    def _pixel(self, at: Point) -> Point:
        x, y = self.tab.screen(at)
        return round(x), round(y)
