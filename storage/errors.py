"""Errors of a project, worded so that a person can put them right."""

from __future__ import annotations

from fairyring.model.errors import FairyringError


class StoreError(FairyringError):
    """The project, its database or a file of it cannot be used as asked."""
