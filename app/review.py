"""Annotations against the predictions of the latest run: figures per cap and per image."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from storage.records import Annotation, Document


@dataclass(frozen=True)
class CapFigures:
    """How far the matched prediction's centre lies from a cap's marked centre."""

    cdr: float | None
    px: float
    relative: float
    dx: float
    dy: float


def figures_of_cap(document: Document, annotations: Mapping[str, Annotation], uid: str) -> CapFigures | None:
    """None where no prediction matches."""
    return None
