"""A fitted image that is kept up to date, and works out no more than is asked for."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.app.bench.crowd import crowded_outlines
from fairyring.app.caps.fitting import Fitting, known_statistics
from fairyring.model.contour import fitted_image, together
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
