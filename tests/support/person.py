"""Somebody who edits without a pause over the real sockets, and keeps what was not acknowledged."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Sequence
from uuid import uuid4

from websockets.exceptions import WebSocketException

from fairyring.app.protocol import Edits, Outcomes
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.records import Accepted, Annotation, Cap, Conflict, Edit
from tests.support.tab import Tab

MOST_AT_ONCE = 4


class Person(threading.Thread):
    """Makes, moves, marks, deletes and undoes caps, some of which all share, until told to stop."""

    def __init__(self, port: int, *, name: str, image: int, seed: int) -> None:
        super().__init__(name=name, daemon=True)
        self._port, self._image = port, image
        self._chance = random.Random(seed)
        self._stop_asked = threading.Event()
        self._known: dict[str, list[Annotation]] = {}
        """What was acknowledged of each cap, the latest last."""
        self._waiting: list[Edit] = []
        self.sent: dict[str, Edit] = {}
        self.acknowledged: dict[str, Annotation] = {}
        """By edit."""
        self.refused: list[str] = []

    def stop(self) -> None:
        """Ends once all that was sent is acknowledged."""
        self._stop_asked.set()
        self.join(60)
        assert not self.is_alive(), f"{self.name} could not save all"
        assert not self._waiting, f"{self.name} gave up"

    def run(self) -> None:
        while self._waiting or not self._stop_asked.is_set():
            try:
                with Tab(self._port, name=self.name, image=self._image) as tab:
                    self._work(tab)
            except (OSError, WebSocketException, TimeoutError):
                time.sleep(0.05)

    def _work(self, tab: Tab) -> None:
        while self._waiting or not self._stop_asked.is_set():
            if not self._waiting:
                new = [self._new() for _ in range(self._chance.randint(1, MOST_AT_ONCE))]
                self._waiting = list({edit.annotation: edit for edit in new}.values())
                self.sent |= {edit.id: edit for edit in self._waiting}
            tab.send(Edits(edits=self._waiting))
            self._take(self._waiting, tab.expect(Outcomes))
            self._waiting = []

    def _new(self) -> Edit:
        uid = self._chance.choice([uuid4().hex, f"shared-{self._chance.randrange(3)}", *self._known])
        before = self._known.get(uid, [])
        base = before[-1].revision if before else 0
        return Edit(id=uuid4().hex, annotation=uid, image=self._image, base=base, cap=self._cap(before))

    def _cap(self, before: Sequence[Annotation]) -> Cap | None:
        what = self._chance.random()
        if before and not before[-1].deleted and what < 0.15:
            return None
        if len(before) > 1 and what < 0.35:
            return self._chance.choice(before).cap
        x, y = self._chance.randrange(200), self._chance.randrange(100)
        mark = Circle(x + 20.0, y + 20.0, 18.0) if what > 0.8 else None
        return Cap(visible=[[x, y, x + 40.0, y, x + 40.0, y + 40.0, x, y + 40.0]], mark=mark)

    def _take(self, edits: Sequence[Edit], found: Outcomes) -> None:
        assert [outcome.edit for outcome in found.outcomes] == [edit.id for edit in edits]
        for outcome in found.outcomes:
            if isinstance(outcome, Accepted):
                self.acknowledged[outcome.edit] = outcome.annotation
                self._known.setdefault(outcome.annotation.uid, []).append(outcome.annotation)
            elif isinstance(outcome, Conflict):
                self._known.setdefault(outcome.theirs.uid, []).append(outcome.theirs)
            else:
                self.refused.append(outcome.reason)
