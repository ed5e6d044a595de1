"""Whatever is drawn or sent, the answer takes less than a second and less than 200 MB."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import rle_of_mask, rle_of_outline
from fairyring.model.geometry.shapes import GeometryError
from tests.support import tangles
from tests.support.masks import disc, peppered

SIDE = 2000
KINDS: dict[str, Callable[[int], np.ndarray]] = {
    "scattered": tangles.scattered,
    "star": lambda count: tangles.star(count, inner=5),
    "spiral": lambda count: tangles.spiral(count, turns=40, thick=4),
    "comb": lambda count: tangles.comb(count, long=80, degrees=30),
    "zigzag": tangles.zigzag,
    "trembling": tangles.trembling,
    "collinear": tangles.collinear,
    "to and fro": tangles.to_and_fro,
}


def seconds_of(work: Callable[[], Any]) -> float:
    """Of this process, whatever else runs beside it; refusals count as answers."""
    start = time.process_time()
    with suppress(GeometryError):
        work()
    return time.process_time() - start


@given(kind=st.sampled_from(sorted(KINDS)), count=st.integers(4, 20_000), whole=st.booleans())
@settings(max_examples=80)
def test_any_polygon_is_checked_and_drawn_within_a_second(kind: str, count: int, whole: bool) -> None:
    points = KINDS[kind](count)
    part = (points.round() if whole else points).ravel().tolist()

    assert seconds_of(lambda: check_then_draw([part])) < 1


@pytest.mark.parametrize("kind", sorted(KINDS))
@pytest.mark.parametrize("parts", [10, 100, 500])
def test_any_number_of_parts_is_checked_and_drawn_within_a_second(kind: str, parts: int) -> None:
    part = KINDS[kind](20_000 // parts).ravel().tolist()

    assert seconds_of(lambda: check_then_draw([part] * parts)) < 1


@pytest.mark.parametrize("share", [0, 0.001, 0.02, 0.05, 0.2, 0.5, 0.9])
@pytest.mark.parametrize("r", [20, 50, 400, 900])
def test_any_noise_in_a_mask_is_traced_or_refused_within_a_second(r: int, share: float) -> None:
    rle = rle_of_mask(peppered(disc(1000, 1000, r, height=SIDE, width=SIDE), share))

    assert seconds_of(lambda: outline_of_rle(rle)) < 1


def check_then_draw(outline: list[list[float]]) -> None:
    checked = check_outline(outline, width=SIDE, height=SIDE)
    assert check_outline(checked, width=SIDE, height=SIDE) == checked
    rle_of_outline(checked, width=SIDE, height=SIDE)


WORST = """
import resource
import numpy as np
from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import GeometryError

def attempt(work):
    try:
        return work()
    except GeometryError:
        return None

def drawn(points):
    outline = check_outline([points.ravel().tolist()], width=6000, height=6000)
    return rle_of_outline(outline, width=6000, height=6000)

attempt(lambda: outline_of_rle({"size": [10, 10], "counts": [11, 5, 84]}))
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
x = np.arange(250) * 20 + 100.0
attempt(lambda: drawn(np.stack([x, np.where(np.arange(250) % 2, 4000, 100)], axis=1)))
attempt(lambda: drawn(np.random.default_rng(0).uniform(0, 6000, (10_000, 2))))
attempt(lambda: drawn(np.random.default_rng(0).uniform(0, 90, (10_000, 2))))
attempt(lambda: outline_of_rle({"size": [5700, 5880], "counts": [0, 5700 * 5880]}))
attempt(lambda: outline_of_rle({"size": [32768, 32768], "counts": [1 << 29, 1 << 29]}))
attempt(lambda: outline_of_rle({"size": [1000, 1000], "counts": [2] * 500_000}))
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024)
"""


def test_the_worst_that_is_not_refused_takes_less_than_200_mb() -> None:
    ran = subprocess.run([sys.executable, "-c", WORST], capture_output=True, text=True, check=True)
    assert float(ran.stdout) < 200
