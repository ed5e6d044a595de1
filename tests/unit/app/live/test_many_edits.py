"""Whoever opens an image finds it fitted by the time that they accept all of its predictions."""

from __future__ import annotations

import pytest

from fairyring.app.live import many_edits
from fairyring.app.live.many_edits import A_FEW, worker_of_edits
from fairyring.app.protocol import Open, Show
from fairyring.app.workers.crew import crew
from tests.support.tab import Tab, until


def test_an_image_on_which_somebody_stays_is_made_known_and_fitted_where_many_may_be_accepted(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    known: list[tuple[str, int]] = []
    for name in ("take_note", "fit_all"):
        monkeypatch.setattr(many_edits, name, lambda caps, name=name: known.append((name, caps.image.id)))
    monkeypatch.setattr(many_edits, "A_FEW", 1)
    monkeypatch.setattr(many_edits, "STAYS_S", 0.3)
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(Open(image=1))
        tab.expect(Show)
        until(lambda: known[-2:] == [("take_note", 1), ("fit_all", 1)], "the image that is looked at")


def test_many_edits_do_not_hold_up_those_who_drag_a_cap() -> None:
    workers = crew(apart=False)
    assert worker_of_edits(workers, 3, count=A_FEW) is workers.of_image(3)
    assert worker_of_edits(workers, 3, count=A_FEW + 1) is workers.bulk
    workers.close()
