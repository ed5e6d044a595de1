"""Light and shade on a plane with one block on it."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.scene.light import Light, cast_shade, draw_light, shine
from fairyring.model.scene.settings import LightSource

ROWS, COLUMNS = 160, 240
BLOCK = np.s_[70:90, 100:130]


def light(*, elevation_deg: float) -> Light:
    """From the left."""
    elevation = np.radians(elevation_deg)
    return Light(
        direction=np.array([-np.cos(elevation), 0, np.sin(elevation)], np.float32),
        elevation=float(elevation),
        key=np.ones(3, np.float32),
        sky=np.full(3, 0.2, np.float32),
        softness=0.05,
        slant=0.0,
        height=1000.0,
        gloss=0.0,
        dimness=1.0,
    )


def lit_plane(source: Light, *, height: float) -> np.ndarray:
    z = np.zeros((ROWS, COLUMNS), np.float32)
    z[BLOCK] = height
    shade = cast_shade(z, z > 0, source)
    flat = np.stack([np.zeros_like(z), np.zeros_like(z), np.ones_like(z)])
    colour = np.full((3, ROWS, COLUMNS), 0.5, np.float32)
    box = (0, 0, COLUMNS, ROWS)
    return shine(colour, flat, z, box=box, light=source, shade=shade)[1]


def test_a_shadow_falls_away_from_the_light_as_far_as_the_height_says() -> None:
    lit = lit_plane(light(elevation_deg=45), height=40)
    row, free = lit[80], lit[20, 200]
    assert row[140:160].max() < 0.6 * free
    assert row[190:].min() > 0.9 * free
    assert row[60:80].min() > 0.8 * free


def test_a_low_light_casts_longer_shadows() -> None:
    def shaded(elevation_deg: float) -> int:
        lit = lit_plane(light(elevation_deg=elevation_deg), height=20)
        return int((lit[80, 130:] < 0.7 * lit[20, 230]).sum())

    assert shaded(20) > 1.7 * shaded(45) > 0


def test_the_foot_of_a_block_is_darker_than_open_ground() -> None:
    lit = lit_plane(light(elevation_deg=75), height=60)
    assert lit[80, 97] < 0.92 * lit[20, 20]


@pytest.mark.parametrize(("source", "least", "most"), [("top", 48, 80), ("side", 10, 40), ("dark", 35, 85)])
def test_each_light_stands_where_its_name_says(source: LightSource, least: float, most: float) -> None:
    for seed in range(20):
        drawn = draw_light(source, np.random.default_rng(seed))
        assert least <= np.degrees(drawn.elevation) <= most
        assert np.linalg.norm(drawn.direction) == pytest.approx(1, abs=1e-6)
        assert drawn.direction[2] == pytest.approx(np.sin(drawn.elevation), abs=1e-6)
