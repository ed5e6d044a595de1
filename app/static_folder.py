"""The folder with the browser's files: beside ``app`` in a checkout, and where the wheel puts it."""

from pathlib import Path

STATIC = Path(__file__).resolve().parents[1] / "static"
