"""A fitted image that is kept up to date, and works out no more than is asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.app.bench.crowd import crowded_outlines
from fairyring.app.caps import fitting as fitting_module
from fairyring.app.caps.fitting import Fitting, Likely, Seen, known_statistics, likely_by_outline
from fairyring.model.contour import fitted_image, together
from fairyring.model.geometry.boxes import box_of_outline
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Outline
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage.records import Image

IMAGE = Image(id=1, file_name="a.jpg", path="a.jpg", width=3840, height=2160, sha256="")


@pytest.fixture(scope="module")
def caps() -> list[Seen]:
    """Fifty caps on each other."""
    return [Seen(outline) for outline in crowded_outlines(50)]


def fitting() -> Fitting:
    return Fitting(IMAGE, known_statistics(IMAGE))


def test_a_cap_asked_for_alone_is_fitted_as_among_all(caps: list[Seen]) -> None:
    all_at_once = fitting().reconstructions(caps, visible=caps)
    one_by_one = fitting()
    for cap, expected in list(zip(caps, all_at_once, strict=True))[::7]:
        (alone,) = fitting().reconstructions([cap], visible=caps)
        (in_turn,) = one_by_one.reconstructions([cap], visible=caps)
        assert alone.fit == in_turn.fit == expected.fit


def test_a_dragged_cap_is_fitted_as_in_an_image_made_anew(caps: list[Seen]) -> None:
    kept, visible = fitting(), list(caps)
    for index, way in ((3, 5.0), (3, -4.0), (20, 6.0), (3, 2.0)):
        first = visible[index].outline[0]
        visible[index] = Seen([[first[0] + way, *first[1:]]])
        (dragged,) = kept.reconstructions([visible[index]], visible=visible)
        (anew,) = fitting().reconstructions([visible[index]], visible=visible)
        assert dragged.fit == anew.fit
    assert [r.fit for r in kept.reconstructions(visible, visible=visible)] == [
        r.fit for r in fitting().reconstructions(visible, visible=visible)
    ]


def test_a_dragged_cap_among_the_same_others_is_all_that_is_looked_up(
    caps: list[Seen], monkeypatch: pytest.MonkeyPatch
) -> None:
    kept, others = fitting(), tuple(caps[1:])
    kept.reconstructions([caps[0]], visible=others)
    boxed: list[Outline] = []
    monkeypatch.setattr(
        fitting_module, "box_of_outline", lambda outline: boxed.append(outline) or box_of_outline(outline)
    )
    first = caps[0].outline[0]
    moved = Seen([[first[0] + 3, *first[1:]]])
    (dragged,) = kept.reconstructions([moved], visible=others)
    assert boxed == [moved.outline]
    (anew,) = fitting().reconstructions([moved], visible=[moved, *others])
    assert dragged.fit == anew.fit


def test_statistics_are_measured_on_all_that_is_visible_at_first(caps: list[Seen]) -> None:
    alone, all_at_once = Fitting(IMAGE, None), Fitting(IMAGE, None)
    alone.reconstructions(caps[:1], visible=caps)
    all_at_once.reconstructions(caps, visible=caps)
    assert alone.statistics == all_at_once.statistics
    alone.reconstructions(caps[:1], visible=caps[:20])
    assert alone.statistics == all_at_once.statistics


def test_the_same_question_again_takes_no_look(caps: list[Seen], monkeypatch: pytest.MonkeyPatch) -> None:
    kept = fitting()
    first = kept.reconstructions(caps[:3], visible=caps)
    looks: list[str] = []
    for name in ("first_look", "next_look"):
        monkeypatch.setattr(fitted_image, name, lambda *_, name=name, **__: looks.append(name))
    copies = [Seen([list(part) for part in cap.outline]) for cap in caps]
    again = kept.reconstructions(copies[:3], visible=copies[::-1])
    assert [r.fit for r in again] == [r.fit for r in first]
    assert looks == []


def test_one_cap_of_many_is_worked_out_without_looking_at_all(
    caps: list[Seen], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[int] = []

    def counted(rims, *rest):
        seen.append(len(rims.points))
        return together.first_look(rims, *rest)

    monkeypatch.setattr(fitted_image, "first_look", counted)
    across = np.array([1500.0, 0.0])
    far = [
        Seen([(np.reshape(part, (-1, 2)) + across).ravel().tolist() for part in cap.outline]) for cap in caps
    ]
    fitting().reconstructions([caps[0]], visible=[*caps, *far])
    assert 0 < sum(seen) < len(caps)


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
        seen = [Seen(outline)]
        (found,) = kept.reconstructions(seen, visible=seen)
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

    def test_a_centre_is_held_to_be_no_surer_than_the_network_was(self) -> None:
        said = LikelyEllipse(
            parameters=SAID.parameters,
            covariance=tuple(tuple(row) for row in np.diag([0.04, 0.01, 1, 1, 1]).tolist()),
        )
        kept = Fitting(IMAGE, known_statistics(IMAGE), likely_by_outline([(HALF, said)]))
        half = Seen(HALF)
        (found,) = kept.reconstructions([half], visible=[half])
        (bare,) = fitting().reconstructions([half], visible=[half])
        assert found.fit.centre_sd == pytest.approx((60 * 0.2, 60 * 0.1))
        assert max(bare.fit.centre_sd or ()) < 60 * 0.1

    def test_it_holds_for_the_very_outline_it_drew(self) -> None:
        likely = likely_by_outline([(HALF, SAID), (HALF[:0], None)])
        moved = [[HALF[0][0] + 1e-9, *HALF[0][1:]]]
        assert self.centre(moved, likely) == self.centre(moved, {})
        assert self.centre([list(HALF[0])], likely) == self.centre(HALF, likely)

    def test_a_cap_alone_is_fitted_as_among_all(self, caps: list[Seen]) -> None:
        said = [(cap.outline, self.around(cap.outline)) for cap in caps[::2]]
        likely = likely_by_outline(said)
        together = Fitting(IMAGE, known_statistics(IMAGE), likely).reconstructions(caps, visible=caps)
        bare = fitting().reconstructions(caps, visible=caps)
        for index in range(0, 50, 8):
            alone = Fitting(IMAGE, known_statistics(IMAGE), likely)
            (found,) = alone.reconstructions([caps[index]], visible=caps)
            assert found.fit == together[index].fit
            assert found.fit != bare[index].fit

    def around(self, outline: Outline) -> LikelyEllipse:
        x, y = np.mean(np.reshape(outline[0], (-1, 2)), axis=0).tolist()
        covariance = tuple(tuple(row) for row in (np.eye(5) * 0.01).tolist())
        return LikelyEllipse(parameters=(x, y, math.log(40.0), 0.1, 0.0), covariance=covariance)


def test_what_is_said_of_a_rim_changes_the_fit_of_that_cap_until_it_is_taken_back(caps: list[Seen]) -> None:
    kept = fitting()
    (before,) = kept.reconstructions(caps[:1], visible=caps)
    half = before.arcs[0].points.ravel().tolist()
    told = Seen(caps[0].outline, [ToldArc(kind="border", points=half)])
    (after,) = kept.reconstructions([told], visible=[told, *caps[1:]])
    (again,) = kept.reconstructions(caps[:1], visible=caps)
    assert after.coverage_deg < before.coverage_deg
    assert after.fit != before.fit == again.fit
