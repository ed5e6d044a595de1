"""Somebody who knows every cap of a bed, and corrects what was predicted until the page shows the same.

First what is good is accepted, then the open ones are walked through from the worst on. Then the bed is
looked at: false caps are deleted, outlines that are not fine are redrawn where they stray, and missed caps
are taken by a click where the network sees them, else drawn. A second look finds what the first one left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from fairyring.app.bench.browser.hand import Hand
from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.strokes import distances_to, round_of, stray_line
from fairyring.model.evaluate.matching import LEAST_IOU, pairs_by_overlap
from fairyring.model.evaluate.outcomes import FINE_IOU
from fairyring.model.geometry.likeness import overlaps
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Outline, Points, bounds_of_outline, points_of_part

LOOKS = 3
"""How often the bed is looked at, at most."""
LARGE_PX = 50.0
"""What is drawn is zoomed in upon until it is as wide as this, CSS pixels."""
SEEN_PX = 20.0
"""A smaller cap, image pixels, is drawn at once: the network seldom sees it where it was asked before."""
NEAR_PX = 25.0
"""A stroke that begins farther from a rim than this, image pixels, is never meant for it."""
NOTCH = 1.17
"""By how much a notch of the wheel enlarges."""
ANSWERS_MS = 60_000
"""So long the network may take to look at a photo."""


@dataclass(frozen=True)
class Shown:
    """A cap or a prediction as it stands on the page."""

    uid: str
    outline: Outline


@dataclass(frozen=True)
class Findings:
    """What is wrong with the caps of a bed."""

    false: list[Shown]
    poor: list[tuple[Shown, Outline]]
    """Those whose outline is not fine, each with what it should be."""
    missed: list[Outline]

    def __bool__(self) -> bool:
        return bool(self.false or self.poor or self.missed)


class Annotator:
    """Corrects the image on screen; ``truth``: the visible outlines of its caps.

    ``hand.done`` is what that took.
    """

    def __init__(self, tab: Tab, truth: Sequence[Outline]) -> None:
        self._tab = tab
        self._truth = list(truth)
        image = tab.state("image")
        self._width, self._height = image["width"], image["height"]
        self.hand = Hand(tab)

    def correct(self) -> None:
        """From the predictions to an image that is done."""
        self.hand.decide()
        self.hand.press("Shift+A", "Enter")
        self._walk()
        for look in range(LOOKS):
            found = self._find(self._shown("shapes"))
            if not found:
                break
            self._delete(found.false)
            if look == 0:
                self._redraw(found.poor)
                self._draw(self._take(found.missed))
            else:
                self._delete([cap for cap, _ in found.poor])
                self._draw([*found.missed, *(rim for _, rim in found.poor)])
        self._finish()

    def _walk(self) -> None:
        """From the worst open prediction to the best: each is turned down, put right, or right."""
        while self._shown("predictions"):
            self.hand.press("Space")
            met = [cap for cap in self._shown("predictions") if cap.uid in self._tab.state("selection")]
            if not met:
                break
            found = self._find([*self._shown("shapes"), *met])
            self.hand.decide()
            if met[0] in found.false:
                self.hand.press("Delete")
            for cap, rim in found.poor:
                if cap in met:
                    self._stroke(cap, rim, key="Control")
        self.hand.press("f")

    def _delete(self, caps: Sequence[Shown]) -> None:
        for cap in caps:
            self.hand.decide()
            self.hand.point(_inside(cap.outline))
            self.hand.press("Delete")

    def _redraw(self, caps: Sequence[tuple[Shown, Outline]]) -> None:
        if caps:
            self.hand.press("r")
        for cap, rim in caps:
            self.hand.decide()
            near = self._come_near(rim)
            if not self._is_meant(cap, rim):
                self.hand.point(_inside(cap.outline))
                self.hand.click()
            self._stroke(cap, rim)
            self._go_back(near)

    def _is_meant(self, cap: Shown, rim: Outline) -> bool:
        """Whether a stroke along this rim changes this cap though it is not selected: no other is near."""
        start = _stray(cap, rim)[0]
        away = {shown.uid: _away(shown.outline, start) for shown in self._shown("shapes")}
        selected = [away.get(uid, math.inf) for uid in self._tab.state("selection")]
        return min(away, key=away.__getitem__) == cap.uid and min(selected, default=math.inf) > NEAR_PX

    def _stroke(self, cap: Shown, rim: Outline, *, key: str | None = None) -> None:
        """Along the rim where an outline strays from it, with a key held or none."""
        self.hand.draw(_stray(cap, rim), key=key)

    def _take(self, rims: Sequence[Outline]) -> list[Outline]:
        """Takes caps as the network sees them; those that it does not see well are left."""
        large = [rim for rim in rims if max(bounds_of_outline(rim)[2:]) >= SEEN_PX]
        left = [rim for rim in rims if rim not in large]
        if large:
            self.hand.press("e")
        for rim in large:
            before = self._shown("shapes")
            self.hand.decide()
            self.hand.point(_inside(rim))
            self.hand.click()
            self._tab.page.wait_for_function("() => !window.fairyring.state.asking", timeout=ANSWERS_MS)
            taken = [cap for cap in self._shown("shapes") if cap not in before]
            if taken and self._likeness(taken[0].outline, rim) < FINE_IOU:
                self.hand.press("Control+z")
            if not taken or self._likeness(taken[0].outline, rim) < FINE_IOU:
                left.append(rim)
        return left

    def _draw(self, rims: Sequence[Outline]) -> None:
        """Draws caps freehand, part by part."""
        for rim in rims:
            self.hand.decide()
            near = self._come_near(rim)
            for nth, part in enumerate(sorted(rim, key=len, reverse=True)):
                self.hand.press("Shift+W" if nth else "w")
                self.hand.draw(_line(round_of(part)))
            self._go_back(near)

    def _come_near(self, rim: Outline) -> bool:
        """Zooms in upon what is small; whether that was needed."""
        x, y, width, height = bounds_of_outline(rim)
        across = max(width, height) * self._tab.page.evaluate("() => window.fairyring.view.scale")
        if across >= LARGE_PX:
            return False
        # What lies at the border of the photo stays there, and in sight.
        self.hand.point((x + width * x / self._width, y + height * y / self._height))
        self.hand.wheel(math.ceil(math.log(LARGE_PX / across, NOTCH)))
        return True

    def _go_back(self, near: bool) -> None:
        if near:
            self.hand.press("f")

    def _finish(self) -> None:
        self.hand.decide()
        self.hand.press("Escape", "Control+Enter")
        question = self._tab.page.get_by_role("alertdialog", name="Question")
        if question.count():
            self.hand.decide()
            self.hand.press("Tab", "Enter")
        self._tab.wait_for("window.fairyring.state.image.status === 'annotated'")
        self._tab.saved()

    def _shown(self, what: str) -> list[Shown]:
        return [Shown(shape["uid"], shape["cap"]["visible"]) for shape in self._tab.state(what)]

    def _find(self, caps: Sequence[Shown]) -> Findings:
        iou = np.zeros((len(self._truth), len(caps)))
        for pair, value in self._overlaps(self._truth, [cap.outline for cap in caps]).items():
            iou[pair] = value
        pairs = pairs_by_overlap(iou, least=LEAST_IOU)
        rims, found = {rim for rim, _ in pairs}, {cap for _, cap in pairs}
        return Findings(
            false=[cap for nth, cap in enumerate(caps) if nth not in found],
            poor=[(caps[cap], self._truth[rim]) for rim, cap in pairs if iou[rim, cap] < FINE_IOU],
            missed=[rim for nth, rim in enumerate(self._truth) if nth not in rims],
        )

    def _likeness(self, outline: Outline, rim: Outline) -> float:
        return self._overlaps([outline], [rim]).get((0, 0), 0.0)

    def _overlaps(self, ones: Sequence[Outline], others: Sequence[Outline]) -> dict[tuple[int, int], float]:
        return overlaps(ones, others, width=self._width, height=self._height)


def _stray(cap: Shown, rim: Outline) -> list[Point]:
    """Of the largest part: the others are put right by drawing the cap anew."""
    return _line(stray_line(max(cap.outline, key=len), max(rim, key=len)))


def _line(points: Points) -> list[Point]:
    return [(x, y) for x, y in points.tolist()]


def _away(outline: Outline, place: Point) -> float:
    """How far a place is from a rim."""
    return min(float(distances_to(part, np.array([place]))[0]) for part in outline)


def _inside(outline: Outline) -> Point:
    """The point of a cap farthest from its rim."""
    x, y, width, height = bounds_of_outline(outline)
    corner = np.array([math.floor(x) - 1, math.floor(y) - 1])
    moved = [(points_of_part(part) - corner).ravel().tolist() for part in outline]
    covered = mask_of_outline(moved, width=math.ceil(width) + 3, height=math.ceil(height) + 3)
    away = cv2.distanceTransform(covered, cv2.DIST_L2, 5)
    row, column = np.unravel_index(int(away.argmax()), away.shape)
    return float(corner[0] + column + 0.5), float(corner[1] + row + 0.5)
