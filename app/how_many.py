"""A number and what it counts, as a sentence has them."""

from __future__ import annotations


def how_many(count: int, thing: str) -> str:
    """``1 image``, ``2 images``; ``thing`` is one of them."""
    return f"{count} {thing}" if count == 1 else f"{count} {thing}s"
