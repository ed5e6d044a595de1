"""The names of the contour methods. Light to import: the command line lists them."""

from __future__ import annotations

from enum import StrEnum


class MethodName(StrEnum):
    """Ways to reconstruct a cap; `model.contour.methods` holds what they do."""

    map = "map"
    paper = "paper"
    literal = "literal"
    ellipse = "ellipse"
    hull = "hull"
    enclosing = "enclosing"
