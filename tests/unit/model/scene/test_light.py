"""The three lights."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.light_and_form import LightSource
from fairyring.model.scene.light import draw_light


@pytest.mark.parametrize(("source", "least", "most"), [("top", 58, 84), ("side", 10, 40), ("dark", 35, 85)])
def test_each_light_stands_where_its_name_says(source: LightSource, least: float, most: float) -> None:
    for seed in range(20):
        drawn = draw_light(source, np.random.default_rng(seed))
        assert least <= np.degrees(drawn.elevation) <= most
        assert np.linalg.norm(drawn.direction) == pytest.approx(1, abs=1e-6)
        assert drawn.direction[2] == pytest.approx(np.sin(drawn.elevation), abs=1e-6)
