"""What processes beside the server are asked about an image's caps, besides fits of edits and drags.

They import this file once for all of them, and nothing that only the server needs: a process is up sooner,
and takes less memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fairyring.app.caps.comparison import compare_cap
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.whole_outlines import arcs_of, note_of, reconstruction_of
from fairyring.app.protocol import Arc
from fairyring.model.evaluate.centres import Pair
from fairyring.storage.records import Prediction


def take_note(_caps: ImageCaps) -> None:
    """Does nothing more: a process that is asked about caps has begun, and keeps them."""


def fit_all(caps: ImageCaps) -> None:
    """Fits all that is visible: what is asked later is known already."""
    visible = list(caps.visible.values())
    caps.fitting.reconstructions(visible, visible=visible)


def judged(caps: ImageCaps, uid: str, said: Sequence[Prediction]) -> tuple[str, list[Arc], Pair | None]:
    """How a cap's whole outline came about, from which arcs, and its matching prediction among those near."""
    found = reconstruction_of(uid, caps.annotations[uid].cap, caps)
    return note_of(found), arcs_of(found), compare_cap(replace(caps, predictions=said), uid)
