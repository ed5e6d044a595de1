"""A cap in the hand: what is shown, what is stored, and that it is worked out once."""

from __future__ import annotations

import pytest

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.live import many_edits
from fairyring.app.protocol import Fitted, Refit, Select, Show
from fairyring.model.contour import fitted_image
from fairyring.storage.project import Project
from fairyring.storage.records import Cap, Edit
from tests.support.tab import Tab, until
from tests.unit.app.conftest import circle


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Grows by every look that is taken at caps."""
    taken: list[str] = []
    for name in ("first_look", "next_look"):
        look = getattr(fitted_image, name)

        def counted(*given, look=look, name=name, **options):
            taken.append(name)
            return look(*given, **options)

        monkeypatch.setattr(fitted_image, name, counted)
    # What is fitted once somebody stays on an image would be counted, too.
    monkeypatch.setattr(many_edits, "fit_all", lambda _caps: None)
    return taken


def test_a_released_drag_is_fitted_once(port: int, looks: list[str]) -> None:
    dragged = Cap(visible=circle(75, 55, 22))
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(Refit(seq=1, image=2, annotation="cap-1", cap=dragged))
        live = tab.expect(Fitted)
        assert looks != []
        looks.clear()
        (outcome,) = tab.edit(Edit(id="e", annotation="cap-1", image=2, base=0, cap=dragged)).outcomes
        tab.send(Select(annotations=["cap-1"]))
        until(lambda: live.note in tab.panel.html, "the inspector")
        assert (outcome.annotation.whole, outcome.annotation.centre) == (live.fit.whole, live.fit.centre)
        assert looks == []


def test_a_prediction_selected_and_accepted_stays_where_it_is(
    port: int, project: Project, looks: list[str]
) -> None:
    fill_in(project)
    with Tab(port, image=1) as tab:
        left, right = tab.expect(Show).contents.predictions
        cap = Cap(visible=left.visible, prediction=left.id)
        tab.send(Refit(seq=1, image=1, annotation=f"prediction:{left.id}", cap=cap))
        live = tab.expect(Fitted)
        looks.clear()
        (outcome,) = tab.edit(Edit(id="e", annotation="a", image=1, base=0, cap=cap)).outcomes
        assert (outcome.annotation.whole, outcome.annotation.centre) == (left.whole, left.centre)
        assert (live.fit.whole, live.fit.centre) == (left.whole, left.centre)
        assert looks == []
        other = Cap(visible=right.visible, prediction=right.id)
        (outcome,) = tab.edit(Edit(id="f", annotation="b", image=1, base=0, cap=other)).outcomes
        assert (outcome.annotation.whole, outcome.annotation.centre) == (right.whole, right.centre)
