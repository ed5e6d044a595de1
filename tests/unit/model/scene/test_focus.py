"""Depth of field against the thin lens."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.model.scene.focus import blur_of, focused
from fairyring.model.scene.pixels import Image

ROWS, COLUMNS, EDGE = 40, 120, 60


def edge() -> Image:
    light = np.zeros((3, ROWS, COLUMNS), np.float32)
    light[:, :, EDGE:] = 1
    return light


def width_of_edge(seen: Image) -> float:
    """Standard deviation of an edge's derivative, px; an ideal edge between pixels has that of a pixel."""
    slope = np.diff(seen[1, ROWS // 2, 20:-20])
    place = np.arange(len(slope))
    mean = (place * slope).sum() / slope.sum()
    return math.sqrt(((place - mean) ** 2 * slope).sum() / slope.sum())


def test_blur_is_what_the_lens_makes_of_the_distance() -> None:
    # From 1000 px, in focus at 900: 150 px below it the blur is the setting's, which makes the lens
    # 2 * 1050 / 150 = 14 wide; at a distance of 700 it spreads by 14 * 200 / 700.
    z = np.array([[-50.0, 100.0, 300.0]], np.float32)
    found = blur_of(z, focus=100.0, distance=1000.0, defocus=2.0)
    assert found[0] == pytest.approx([-2.0, 0.0, 4.0], abs=1e-5)


@pytest.mark.parametrize("blur", [-3.0, -1.2, 0.9, 2.0])
@pytest.mark.parametrize("sharpness", [0.7, 1.0])
def test_an_edge_gets_as_wide_as_its_blur_and_the_lens_sharpness_together(
    blur: float, sharpness: float
) -> None:
    seen = focused(edge(), np.full((ROWS, COLUMNS), blur, np.float32), sharpness=sharpness)
    assert width_of_edge(seen) == pytest.approx(math.hypot(blur, sharpness), rel=0.05)


def test_half_way_out_of_focus_an_edge_has_the_blur_of_half_way() -> None:
    blur = np.full((ROWS, COLUMNS), -1.5, np.float32)
    # The lowest of the picture is blurred most, far from the edge.
    blur[:, :10] = -3.0
    assert width_of_edge(focused(edge(), blur, sharpness=0.7)) == pytest.approx(
        math.hypot(1.5, 0.7), rel=0.05
    )


def test_a_sharp_cap_keeps_its_edge_before_blurred_ground() -> None:
    light, blur = edge(), np.zeros((ROWS, COLUMNS), np.float32)
    blur[:, :EDGE] = -3.0
    assert width_of_edge(focused(light, blur, sharpness=0.7)) < 0.9


def test_a_picture_of_one_tone_stays_so_whatever_its_depth() -> None:
    across = np.linspace(-4, 2, COLUMNS, dtype=np.float32)
    blur = np.broadcast_to(across, (ROWS, COLUMNS)).copy()
    seen = focused(np.full((3, ROWS, COLUMNS), 0.6, np.float32), blur, sharpness=0.7)
    assert seen == pytest.approx(0.6, abs=1e-4)
