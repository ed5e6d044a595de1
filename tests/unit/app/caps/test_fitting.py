"""A fitted image that is kept up to date, and works out no more than is asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.app.bench.crowd import crowded_outlines
from fairyring.app.caps.fitting import Fitting, Likely, known_statistics, likely_by_outline
from fairyring.model.contour import fitted_image, together
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Outline
from fairyring.storage.records import Image

IMAGE = Image(id=1, file_name="a.jpg", path="a.jpg", width=3840, height=2160, sha256="")


@pytest.fixture(scope="module")
def outlines() -> list[Outline]:
    """Fifty caps on each other."""
    return crowded_outlines(50)


def fitting() -> Fitting:
    return Fitting(IMAGE, known_statistics(IMAGE))


def test_a_cap_asked_for_alone_is_fitted_as_among_all(outlines: list[Outline]) -> None:
    all_at_once = fitting().reconstructions(outlines, visible=outlines)
    one_by_one = fitting()
    for outline, expected in list(zip(outlines, all_at_once, strict=True))[::7]:
        (alone,) = fitting().reconstructions([outline], visible=outlines)
        (in_turn,) = one_by_one.reconstructions([outline], visible=outlines)
        assert alone.fit == in_turn.fit == expected.fit


def test_a_dragged_cap_is_fitted_as_in_an_image_made_anew(outlines: list[Outline]) -> None:
    kept, visible = fitting(), list(outlines)
    for index, way in ((3, 5.0), (3, -4.0), (20, 6.0), (3, 2.0)):
        first = visible[index][0]
        visible[index] = [[first[0] + way, *first[1:]]]
        (dragged,) = kept.reconstructions([visible[index]], visible=visible)
        (anew,) = fitting().reconstructions([visible[index]], visible=visible)
        assert dragged.fit == anew.fit
    assert [r.fit for r in kept.reconstructions(visible, visible=visible)] == [
        r.fit for r in fitting().reconstructions(visible, visible=visible)
    ]


def test_statistics_are_measured_on_all_that_is_visible_at_first(outlines: list[Outline]) -> None:
    alone, all_at_once = Fitting(IMAGE, None), Fitting(IMAGE, None)
    alone.reconstructions(outlines[:1], visible=outlines)
    all_at_once.reconstructions(outlines, visible=outlines)
    assert alone.statistics == all_at_once.statistics
    alone.reconstructions(outlines[:1], visible=outlines[:20])
    assert alone.statistics == all_at_once.statistics


def test_the_same_question_again_takes_no_look(
    outlines: list[Outline], monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = fitting()
    first = kept.reconstructions(outlines[:3], visible=outlines)
    looks: list[str] = []
    for name in ("first_look", "next_look"):
        monkeypatch.setattr(fitted_image, name, lambda *_, name=name, **__: looks.append(name))
    copies = [[list(part) for part in outline] for outline in outlines]
    again = kept.reconstructions(copies[:3], visible=copies[::-1])
    assert [r.fit for r in again] == [r.fit for r in first]
    assert looks == []


def test_one_cap_of_many_is_worked_out_without_looking_at_all(
    outlines: list[Outline], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[int] = []

    def counted(rims, *rest):
        seen.append(len(rims.points))
        return together.first_look(rims, *rest)

    monkeypatch.setattr(fitted_image, "first_look", counted)
    across = np.array([1500.0, 0.0])
    far = [[(np.reshape(part, (-1, 2)) + across).ravel().tolist() for part in o] for o in outlines]
    fitting().reconstructions([outlines[0]], visible=[*outlines, *far])
    assert 0 < sum(seen) < len(outlines)


HALF: Outline = [[v for t in np.linspace(0, np.pi, 25) for v in (400 + 60 * np.cos(t), 300 + 60 * np.sin(t))]]
"""What is in sight of a circle around (400, 300)."""
SAID = LikelyEllipse(
    parameters=(400.0, 290.0, math.log(60.0), 0.0, 0.0),
    covariance=tuple(tuple(row) for row in (np.eye(5) * 1e-6).tolist()),
)
"""Where a network is sure to see it."""


class TestWhatANetworkSaid:
    def centre(self, outline: Outline, likely: Likely) -> tuple[float, float]:
        kept = Fitting(IMAGE, known_statistics(IMAGE), likely)
        (found,) = kept.reconstructions([outline], visible=[outline])
        assert found.fit.centre is not None
        return found.fit.centre

    def test_it_draws_the_whole_outline_towards_itself(self) -> None:
        likely = likely_by_outline([(HALF, SAID)])
        assert self.centre(HALF, {}) == pytest.approx((400, 300), abs=1.5)
        assert self.centre(HALF, likely) == pytest.approx((400, 290), abs=0.5)
        unsure = LikelyEllipse(
            parameters=SAID.parameters,
            covariance=tuple(tuple(row) for row in (np.eye(5) * 1e4).tolist()),
        )
        without = self.centre(HALF, {})
        assert self.centre(HALF, likely_by_outline([(HALF, unsure)])) == pytest.approx(without, abs=0.01)

    def test_it_holds_for_the_very_outline_it_drew(self) -> None:
        likely = likely_by_outline([(HALF, SAID), (HALF[:0], None)])
        moved = [[HALF[0][0] + 1e-9, *HALF[0][1:]]]
        assert self.centre(moved, likely) == self.centre(moved, {})
        assert self.centre([list(HALF[0])], likely) == self.centre(HALF, likely)

    def test_a_cap_alone_is_fitted_as_among_all(self, outlines: list[Outline]) -> None:
        said = [(outline, self.around(outline)) for outline in outlines[::2]]
        likely = likely_by_outline(said)
        together = Fitting(IMAGE, known_statistics(IMAGE), likely).reconstructions(outlines, visible=outlines)
        bare = fitting().reconstructions(outlines, visible=outlines)
        for index in range(0, 50, 8):
            alone = Fitting(IMAGE, known_statistics(IMAGE), likely)
            (found,) = alone.reconstructions([outlines[index]], visible=outlines)
            assert found.fit == together[index].fit
            assert found.fit != bare[index].fit

    def around(self, outline: Outline) -> LikelyEllipse:
        x, y = np.mean(np.reshape(outline[0], (-1, 2)), axis=0).tolist()
        covariance = tuple(tuple(row) for row in (np.eye(5) * 0.01).tolist())
        return LikelyEllipse(parameters=(x, y, math.log(40.0), 0.1, 0.0), covariance=covariance)
