"""What a tab shows, pixel by pixel."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.app.bench.browser.tab import Point, Tab


def pixels(tab: Tab, low: Point, high: Point) -> NDArray[np.uint8]:
    """(height, width, 3) of the screen between two image points, once all is drawn."""
    tab.page.evaluate("() => new Promise((resolve) => window.fairyring.whenDrawn(resolve))")
    (left, top), (right, bottom) = tab.screen(low), tab.screen(high)
    box = {"x": left, "y": top, "width": right - left, "height": bottom - top}
    shot = tab.page.screenshot(clip=box)
    decoded = cv2.imdecode(np.frombuffer(shot, np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    return np.asarray(decoded, np.uint8)
