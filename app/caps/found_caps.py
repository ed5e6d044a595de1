"""The cap that the network sees at points of a photo; for a worker, which keeps what the network saw."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from itertools import compress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.app.caps.image_caps import ImageCaps
from fairyring.model import photo
from fairyring.model.geometry.boxes import touching
from fairyring.model.geometry.shapes import Outline
from fairyring.model.processes import usable_cores

if TYPE_CHECKING:
    from fairyring.model.predict.predictor import Predictor
    from fairyring.model.predict.seen import Detection, Seen

PHOTOS = 2
"""What was seen in so many photos is remembered: two people may point, each in another."""
NEAR_PX = 300.0
"""Caps farther from what is pointed at than this hide nothing of it."""


class Asked(Struct, frozen=True, kw_only=True):
    """What is asked of the network, image pixels."""

    photo: Path
    weights: Path
    points: Sequence[tuple[float, float]] = ()
    wanted: Sequence[bool] = ()
    """Of each point, whether it is to be on the cap; the first is."""
    box: tuple[float, float, float, float] | None = None
    front: Sequence[Outline] = ()
    """What other caps show, of which it may show no pixel."""


def cap_found(asked: Asked) -> tuple[float, Outline] | None:
    """The score and the outline of the cap; None where the network sees none, or was to look only."""
    # While a photo is looked at, somebody may have a cap in hand.
    with _threads(max(1, usable_cores() - 1)):
        predictor, seen = _seen(asked.photo, asked.weights, asked.weights.stat().st_mtime_ns)
    found: Detection | None = None
    # One cap is too little work to share: threads that wait for some keep cores busy.
    with _threads(1):
        if asked.box is not None:
            found = predictor.within(seen, asked.box, front=asked.front)
        elif asked.points:
            found = predictor.at(seen, asked.points, asked.wanted, front=asked.front)
    return None if found is None else (found.score, found.outline)


@contextmanager
def _threads(count: int) -> Iterator[None]:
    """Has PyTorch compute with so many threads."""
    # PyTorch is loaded by the worker when somebody points for the first time, and never by the server.
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def near(caps: ImageCaps, places: Sequence[tuple[float, float]], *, besides: str | None) -> list[Outline]:
    """What is visible of the caps whose box is near to one of the places, but of the cap ``besides``."""
    points = np.reshape(np.array(places, np.float64), (-1, 2))
    around = np.concatenate([points - NEAR_PX, points + NEAR_PX], axis=1)
    meeting: NDArray[np.bool_] = np.logical_or.reduce(touching(caps.boxes, around), axis=1)
    return [seen.outline for uid, seen in compress(caps.visible.items(), meeting.tolist()) if uid != besides]


@lru_cache(maxsize=PHOTOS)
def _seen(path: Path, weights: Path, changed: int) -> tuple[Predictor, Seen]:
    from fairyring.model.predict.scale import see_at_its_scale

    predictor = _predictor(weights, changed)
    rgb = np.ascontiguousarray(photo.read(path)[:, :, ::-1])
    return predictor, see_at_its_scale(predictor, rgb)


@lru_cache(maxsize=1)
def _predictor(weights: Path, _changed: int) -> Predictor:
    from fairyring.model.device import device_of
    from fairyring.model.network.weights import load_weights
    from fairyring.model.predict.predictor import Predictor

    return Predictor(load_weights(weights).network, device=device_of("auto"))
