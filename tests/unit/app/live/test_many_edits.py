"""Whoever opens an image finds it fitted by the time that they accept all of its predictions."""

from __future__ import annotations

import pytest

from fairyring.app.live import many_edits
from fairyring.app.live.many_edits import A_FEW, worker_of_edits
from fairyring.app.protocol import Open, Show
from fairyring.app.workers.crew import crew
from tests.support.tab import Tab, until


def test_an_image_is_fitted_as_soon_as_it_is_opened(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    fitted: list[int] = []
    monkeypatch.setattr(many_edits, "fit_all", lambda caps: fitted.append(caps.image.id))
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        until(lambda: fitted == [1], "the first image")
        tab.send(Open(image=2))
        tab.expect(Show)
        until(lambda: fitted == [1, 2], "the second image")


def test_many_edits_do_not_hold_up_those_who_drag_a_cap() -> None:
    workers = crew(apart=False)
    assert worker_of_edits(workers, 3, count=A_FEW) is workers.of_image(3)
    assert worker_of_edits(workers, 3, count=A_FEW + 1) is workers.bulk
    workers.close()
