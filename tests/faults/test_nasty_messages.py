"""Messages that no editor sends: the server answers the next one all the same."""

from __future__ import annotations

import logging
import random
import shutil
import time
from pathlib import Path
from typing import Any

import pytest

from fairyring.app.bench.serving import served
from fairyring.app.protocol import Fitted, Open, Outcomes, Refit, Show
from fairyring.storage.records import Accepted, Cap
from tests.support.consistent import faults_of
from tests.support.how_much import inputs
from tests.support.nasty import as_text, changed
from tests.support.tab import Tab

log = logging.getLogger(__name__)
MESSAGES = inputs(of=15_000)
LONGEST_WAIT_S = 3.0
"""Longest time until the next message is answered, by a clock on the wall."""
SQUARE = [20.0, 20.0, 60.0, 20.0, 60.0, 60.0, 20.0, 60.0]


def messages() -> list[dict[str, Any]]:
    """One of each that an editor sends."""
    cap = {"visible": [list(SQUARE)], "mark": {"kind": "circle", "cx": 40, "cy": 40, "r": 20}}
    polygon = {"visible": [], "mark": {"kind": "polygon", "points": list(SQUARE)}}
    edit = {"id": "e", "annotation": "a", "image": 1, "base": 0, "cap": cap}
    return [
        {"type": "edits", "edits": [edit, edit | {"id": "f", "annotation": "b", "cap": polygon}]},
        {"type": "refit", "seq": 1, "image": 1, "annotation": "a", "cap": cap},
        {"type": "open", "image": 1, "select": "a"},
        {"type": "step", "by": 1},
        {"type": "select", "annotation": "a", "prediction": 1},
        {"type": "status", "image": 1, "status": "annotated"},
        {"type": "saving", "waiting": 3},
        {"type": "toggle", "layer": "photo"},
    ]


def longest_wait(tab: Tab, numbers: range, chance: random.Random, acknowledged: dict[str, str]) -> float:
    """Seconds until the server had answered the next message, after one of so many that nobody means.

    Notes the annotations of the edits it acknowledged.
    """
    seeds, longest = messages(), 0.0
    tab.expect(Show)
    # The process that fits starts with the first question.
    tab.send(Refit(seq=0, image=1, annotation="x", cap=Cap(visible=[SQUARE])))
    tab.expect(Fitted, within_s=60)
    for number in numbers:
        seed = changed(chance.choice(seeds), chance, times=chance.randint(1, 3))
        edits = seed.get("edits") if isinstance(seed, dict) and chance.random() < 0.5 else None
        for edit in edits if isinstance(edits, list) else []:
            if isinstance(edit, dict):
                edit |= {"id": f"edit {number}", "annotation": f"cap {number}"}
        tab.editor.send(as_text(seed, chance).decode("utf-8", errors="replace"))
        sent = time.monotonic()
        # It may have opened another image.
        tab.send(Open(image=1))
        tab.send(Refit(seq=10**6 + number, image=1, annotation="x", cap=Cap(visible=[SQUARE])))
        tab.expect(Fitted, lambda found, number=number: found.seq == 10**6 + number, within_s=60)
        longest = max(longest, time.monotonic() - sent)
        for message in tab.received:
            if isinstance(message, Outcomes):
                accepted = [each for each in message.outcomes if isinstance(each, Accepted)]
                acknowledged |= {each.edit: each.annotation.uid for each in accepted}
        tab.received.clear()
    return longest


@pytest.mark.timeout(3600)
def test_whatever_an_editor_sends_the_server_answers_the_next_within_a_second(
    beds: Path, tmp_path: Path
) -> None:
    chance = random.Random(3)
    folder = Path(shutil.copytree(beds, tmp_path / "beds"))
    acknowledged: dict[str, str] = {}
    longest = 0.0
    with served(folder) as server:
        for first in range(0, MESSAGES, 500):
            numbers = range(first, min(first + 500, MESSAGES))
            with Tab(server.port, image=1) as tab:
                longest = max(longest, longest_wait(tab, numbers, chance, acknowledged))
    log.info("messages: %d inputs, the longest wait %.2f s", MESSAGES, longest)
    assert faults_of(folder / "project.db", acknowledged=acknowledged) == []
    assert longest < LONGEST_WAIT_S
