"""Which grid cells learn which cap: SOLOv2's centre regions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fairyring.model.network.config import LEVELS, NetworkConfig

CENTRE_REGION = 0.2
"""Share of a cap's box whose cells are positive, about the mass centre."""
EMPTY = -1
IGNORED = -2

Cells = NDArray[np.int64]
"""(rows, columns): index of the cap that each cell learns, EMPTY, or IGNORED where it learns nothing."""


def grid_shape(config: NetworkConfig, level: int, *, height: int, width: int) -> tuple[int, int]:
    """Rows and columns of a level's grid on an input of this many photo pixels; at least one of each."""
    cell = config.cell(level)
    return max(1, round(height / cell)), max(1, round(width / cell))


def assign_cells(
    boxes: NDArray[np.float64],
    centres: NDArray[np.float64],
    config: NetworkConfig,
    *,
    height: int,
    width: int,
    ignored: NDArray[np.bool_] | None = None,
) -> list[Cells]:
    """The five levels' cells for the caps of one input of ``height`` × ``width`` photo pixels.

    ``boxes`` (n, 4): x, y, width, height; ``centres`` (n, 2): mass centres of the visible masks. A cap goes
    to the levels whose scale range holds √(box area) in network-input pixels; there to the cells that its
    box, scaled by 0.2 about the centre, touches, at most one away from the centre's own. Of two caps in one
    cell the one whose centre is nearer to the cell's middle has it. ``ignored`` (height, width): cells
    whose middle lies there and that hold no cap are IGNORED.
    """
    sizes = np.sqrt(boxes[:, 2] * boxes[:, 3]) / config.reduction
    levels = []
    for level in range(LEVELS):
        low, high = config.scale_ranges[level]
        chosen = np.flatnonzero((sizes >= low) & (sizes <= high))
        rows, columns = grid_shape(config, level, height=height, width=width)
        cell = np.array([width / columns, height / rows])
        levels.append(_cells_of(chosen, boxes, centres / cell, cell, (rows, columns)))
        if ignored is not None and ignored.any():
            y, x = np.indices((rows, columns)).reshape(2, -1)
            middle = ignored[((y + 0.5) * cell[1]).astype(int), ((x + 0.5) * cell[0]).astype(int)]
            levels[-1][(levels[-1] == EMPTY) & middle.reshape(rows, columns)] = IGNORED
    return levels


def _cells_of(
    chosen: NDArray[np.int64],
    boxes: NDArray[np.float64],
    centres: NDArray[np.float64],
    cell: NDArray[np.float64],
    shape: tuple[int, int],
) -> Cells:
    """``centres`` in cells; ``cell``: width and height of one in photo pixels."""
    cells = np.full(shape, EMPTY, dtype=np.int64)
    distance = np.full(shape, np.inf)
    last = np.array(shape[::-1]) - 1
    for cap in chosen:
        own = np.clip(np.floor(centres[cap]), 0, last)
        reach = CENTRE_REGION / 2 * boxes[cap, 2:] / cell
        first = np.maximum(np.clip(np.floor(centres[cap] - reach), 0, last), own - 1).astype(int)
        final = np.minimum(np.clip(np.floor(centres[cap] + reach), 0, last), own + 1).astype(int)
        window = np.s_[first[1] : final[1] + 1, first[0] : final[0] + 1]
        y, x = np.mgrid[window]
        away = np.hypot(x + 0.5 - centres[cap, 0], y + 0.5 - centres[cap, 1])
        nearer = away < distance[window]
        cells[window][nearer] = cap
        distance[window][nearer] = away[nearer]
    return cells
