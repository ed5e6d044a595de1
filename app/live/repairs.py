"""What is said when an outline was put right as it was stored."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from fairyring.model.geometry.boxes import box_of_outline
from fairyring.model.geometry.self_contact import self_contact
from fairyring.model.geometry.shapes import points_of_part, without_repeats
from fairyring.storage.records import Accepted, Edit, Outcome, Outline

PUT_RIGHT = "The outline ran across itself and was put right there; its other points are where they were."
A_SLIP = 2.0
"""What lies no farther than this, pixels, from the rim as it is stored was a slip of the hand …"""
A_SLIP_OF_LARGE = 0.05
"""… or no farther than this share of the outline's larger side."""


def repairs_told(edits: Sequence[Edit], outcomes: Sequence[Outcome]) -> str | None:
    """The sentence about the outlines of a change set that crossed themselves; None where none did.

    A hand that shakes crosses its own line all the time: where one sees no difference, nothing is said.
    """
    sent = {edit.id: edit.cap.visible for edit in edits if edit.cap is not None}
    stored = {each.edit: each.annotation.cap.visible for each in outcomes if isinstance(each, Accepted)}
    repaired = [
        name
        for name, visible in stored.items()
        if name in sent
        and visible != sent[name]
        and any(map(_crosses_itself, sent[name]))
        and _looks_different(sent[name], visible)
    ]
    if not repaired:
        return None
    parts = max(len(stored[name]) for name in repaired)
    return PUT_RIGHT if parts == 1 else f"{PUT_RIGHT} It has {parts} parts now."


def _crosses_itself(part: list[float]) -> bool:
    points = without_repeats(points_of_part(part))
    contact = self_contact(points)
    return contact.crossings > 0 or contact.touches


def _looks_different(sent: Outline, stored: Outline) -> bool:
    """Whether the outline has another number of parts now, or left points behind that lay off its rim."""
    if len(stored) != len(sent):
        return True
    kept = {tuple(point) for part in stored for point in points_of_part(part).tolist()}
    gone = [point for part in sent for point in points_of_part(part).tolist() if tuple(point) not in kept]
    left, top, right, bottom = box_of_outline(stored)
    slip = max(A_SLIP, A_SLIP_OF_LARGE * max(right - left, bottom - top))
    rims = [points_of_part(part).astype(np.float32) for part in stored]
    return any(min(abs(cv2.pointPolygonTest(rim, (x, y), True)) for rim in rims) > slip for x, y in gone)
