"""The weights that come with Fairyring."""

from __future__ import annotations

from pathlib import Path

SHIPPED = Path(__file__).parents[1] / "weights" / "lite0.safetensors"
RECIPE = SHIPPED.with_suffix(".toml")
"""The recipe they were trained by."""
SECOND_LOOK = SHIPPED.with_name("second_look.toml")
"""The recipe that its second look was trained by, upon the rest."""
