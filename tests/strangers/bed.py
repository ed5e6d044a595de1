"""One photo with two caps, which every stranger's file labels in its own way."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

WIDTH, HEIGHT = 200, 160
DISCS = ((60.0, 70.0, 30.0), (130.0, 90.0, 25.0))
"""Centre and radius of the caps, pixels."""


@dataclass(frozen=True, kw_only=True)
class Stranger:
    """A file as another tool writes it, and what an import makes of it."""

    tool: str
    what: str
    make: Callable[[Path], Sequence[Path]]
    """Writes the files below a folder, and returns the paths to import."""
    caps: int = 2
    """How many caps are in the project then, on all photos together."""
    photos: int = 1
    shape: str = "outline"
    """``outline``, ``box`` or ``circle``: what is known of each cap."""
    exit_code: int = 0
    said: str = ""
    """Part of what is printed."""
    options: tuple[str, ...] = ()
    predictions: bool = False
    """Whether the caps are predictions."""


def photo(path: Path, *, moved: float = 0) -> Path:
    """Writes the photo; ``moved`` caps make it another one."""
    image = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    for x, y, r in DISCS:
        cv2.circle(image, (round(x + moved), round(y)), round(r), (200, 210, 220), -1)
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), image)
    return path


def circle(nth: int, *, scale: tuple[float, float] = (1, 1), count: int = 48) -> list[list[float]]:
    """A cap's rim as points."""
    x, y, r = DISCS[nth]
    # A polygon of the circle's area.
    r *= math.sqrt(2 * math.pi / (count * math.sin(2 * math.pi / count)))
    angles = [2 * math.pi * k / count for k in range(count)]
    return [[scale[0] * (x + r * math.cos(a)), scale[1] * (y + r * math.sin(a))] for a in angles]


def flat(points: Sequence[Sequence[float]]) -> list[float]:
    return [round(number, 4) for point in points for number in point]


def box(nth: int) -> list[float]:
    x, y, r = DISCS[nth]
    return [x - r, y - r, 2 * r, 2 * r]


def mask(nth: int) -> np.ndarray:
    """(HEIGHT, WIDTH) uint8."""
    x, y, r = DISCS[nth]
    rows, columns = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    return ((columns - x) ** 2 + (rows - y) ** 2 <= r * r).astype(np.uint8)


def png(pixels: np.ndarray) -> str:
    """A PNG as text."""
    done, data = cv2.imencode(".png", pixels)
    assert done
    return base64.b64encode(data.tobytes()).decode()


def write(path: Path, value: Any) -> Path:
    """Writes a value as JSON, or a text as it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(value if isinstance(value, str) else json.dumps(value))
    return path
