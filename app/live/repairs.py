"""What is said when an outline was put right as it was stored."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.model.geometry.self_contact import self_contact
from fairyring.model.geometry.shapes import points_of_part, without_repeats
from fairyring.storage.records import Accepted, Edit, Outcome

PUT_RIGHT = "The outline ran across itself and was put right there; its other points are where they were."


def repairs_told(edits: Sequence[Edit], outcomes: Sequence[Outcome]) -> str | None:
    """The sentence about the outlines of a change set that crossed themselves; None where none did."""
    sent = {edit.id: edit.cap.visible for edit in edits if edit.cap is not None}
    stored = {each.edit: each.annotation.cap.visible for each in outcomes if isinstance(each, Accepted)}
    repaired = [
        name
        for name, visible in stored.items()
        if name in sent and visible != sent[name] and any(map(_crosses_itself, sent[name]))
    ]
    if not repaired:
        return None
    parts = max(len(stored[name]) for name in repaired)
    return PUT_RIGHT if parts == 1 else f"{PUT_RIGHT} It has {parts} parts now."


def _crosses_itself(part: list[float]) -> bool:
    points = without_repeats(points_of_part(part))
    contact = self_contact(points)
    return contact.crossings > 0 or contact.touches
