"""Whole outlines and centres, from marks and from what is visible."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
import pytest

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.caps.fitting import Fitting, known_statistics
from fairyring.app.caps.image_caps import ImageCaps, caps_of
from fairyring.app.caps.whole_outlines import derive_edits, note_of, reconstruction_of, refit
from fairyring.app.protocol import Refit
from fairyring.model.geometry.shapes import Circle, Ellipse, Outline, Polygon, diameter_of_shape
from fairyring.storage.contents import load_annotations, load_contents
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Cap, Edit, Image, Prediction
from tests.support.tab import SQUARE, new_cap
from tests.unit.app.conftest import circle

IMAGE = Image(id=1, file_name="a.jpg", path="a.jpg", width=160, height=120, sha256="")


def image_with(*annotations: Annotation) -> ImageCaps:
    known = {annotation.uid: annotation for annotation in annotations}
    return ImageCaps(IMAGE, known, [], Fitting(IMAGE, known_statistics(IMAGE)))


def contents_of(project: Project) -> ImageCaps:
    """As a tab has them."""
    fill_in(project, [1])
    with project.read() as connection:
        return caps_of(load_contents(connection, 1))


def test_a_mark_is_its_own_whole_outline() -> None:
    for mark in (Circle(50, 40, 10), Ellipse(50, 40, 12, 10, 30)):
        fit = reconstruction_of("a", Cap(visible=SQUARE, mark=mark), image_with()).fit
        assert fit.whole == mark
        assert fit.centre == (50, 40)


def test_a_marked_polygon_gives_the_ellipse_fitted_to_its_points() -> None:
    cap = Cap(visible=[], mark=Polygon(circle(60, 50, 20, points=20)[0]))
    found = reconstruction_of("a", cap, image_with())
    assert found.fit.centre == pytest.approx((60, 50), abs=1e-6)
    assert "polygon" in note_of(found)


def test_a_round_cap_is_found_where_it_is() -> None:
    fit = reconstruction_of("a", Cap(visible=circle(70.25, 55.5, 24)), image_with()).fit
    assert fit.centre == pytest.approx((70.25, 55.5), abs=0.1)
    assert fit.whole is not None
    assert diameter_of_shape(fit.whole) == pytest.approx(48, abs=1)


@pytest.mark.parametrize(
    "visible", [[], [[]], [[1.0, 2.0]], [[1.0, 2.0, 3.0]], [[1e12, 0.0, 0.0, 1e12, -1e12, 0.0]], [[5.0] * 8]]
)
def test_a_wild_outline_gives_a_sentence_and_never_reaches_the_rasteriser(visible: list) -> None:
    found = reconstruction_of("a", Cap(visible=visible), image_with())
    assert found.fit.whole is None
    assert note_of(found).endswith(".")


@pytest.mark.parametrize("mark", [Circle(50, 40, -1), Circle(1e12, 0, 5), Polygon([1.0, 2.0, 3.0])])
def test_a_wild_mark_gives_a_sentence(mark: Circle | Polygon) -> None:
    fit = reconstruction_of("a", Cap(visible=SQUARE, mark=mark), image_with()).fit
    assert fit.whole is None
    assert fit.refusal is not None


def test_what_is_visible_leaves_out_predictions_that_somebody_took_up(project: Project) -> None:
    left, right = contents_of(project).predictions
    commit(project, [Derived(edit=new_cap(1, prediction=left.id))], user="Ada")
    with project.read() as connection:
        annotations = {a.uid: a for a in load_annotations(connection, 1)}
    caps = contents_of(project).with_annotations(annotations)
    assert set(caps.visible) == {"cap-1", f"prediction {right.id}"}


def test_a_refit_says_what_the_edit_will_store(project: Project) -> None:
    cap = Cap(visible=circle(90, 70, 18))
    live = refit(contents_of(project), Refit(seq=1, image=1, annotation="a", cap=cap))
    (stored,) = derive_edits(project, [Edit(id="e", annotation="a", image=1, base=0, cap=cap)])
    assert live.fit == stored.fit


def test_a_refit_tells_the_arcs_of_an_outline_apart_and_how_well_the_centre_is_known() -> None:
    whole, cut = circle(70, 55, 24), circle(4, 60, 24)
    cut[0][0::2] = [max(x, 0.0) for x in cut[0][0::2]]
    free, bordered = (
        refit(image_with(), Refit(seq=1, image=1, annotation="a", cap=Cap(visible=outline)))
        for outline in (whole, cut)
    )
    assert [arc.kind for arc in free.arcs] == ["visible"]
    around = np.reshape(free.arcs[0].points, (-1, 2))
    assert np.hypot(*(around - (70, 55)).T) == pytest.approx(24, abs=1.0)
    assert sorted(arc.kind for arc in bordered.arcs) == ["border", "visible"]
    border = next(arc for arc in bordered.arcs if arc.kind == "border")
    assert max(border.points[0::2]) < 2
    assert free.fit.centre_sd is not None
    assert bordered.fit.centre_sd is not None
    assert 0 < free.fit.centre_sd[0] < bordered.fit.centre_sd[0]
    assert free.note.startswith("regular")
    assert bordered.note.startswith("irregular")


def test_a_refit_names_the_piece_that_a_neighbour_hides() -> None:
    """A cap at (60, 60) with its right side, from x = 70 on, under the round cap at (90, 60)."""
    angles = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    rim = np.stack([60 + 24 * np.cos(angles), 60 + 24 * np.sin(angles)], axis=1)
    away = rim - (90, 60)
    far = np.maximum(np.hypot(*away.T), 24)[:, None]
    bitten = (90, 60) + away / np.hypot(*away.T)[:, None] * far
    front = Annotation(uid="front", image=1, revision=1, cap=Cap(visible=circle(90, 60, 24, points=80)))
    cap = Cap(visible=[bitten.ravel().tolist()])
    live = refit(image_with(front), Refit(seq=1, image=1, annotation="a", cap=cap))
    assert live.fit.centre == pytest.approx((60, 60), abs=0.5)
    hidden = [arc for arc in live.arcs if arc.kind == "hidden"]
    assert len(hidden) == 1
    seam = np.reshape(hidden[0].points, (-1, 2))
    assert np.hypot(*(seam - (90, 60)).T) == pytest.approx(24, abs=1.5)


def test_a_mark_has_no_arcs_and_the_deviation_of_a_hand() -> None:
    cap = Cap(visible=SQUARE, mark=Circle(50, 40, 10))
    live = refit(image_with(), Refit(seq=1, image=1, annotation="a", cap=cap))
    assert (live.arcs, live.fit.centre_sd, live.note) == ([], (0.4, 0.4), "the marked circle")


def test_a_refit_of_a_wild_outline_says_why_there_is_none() -> None:
    cap = Cap(visible=[[1.0, 2.0]])
    live = refit(image_with(), Refit(seq=1, image=1, annotation="a", cap=cap))
    assert (live.fit.whole, live.fit.centre, live.arcs) == (None, None, [])
    assert live.note == live.fit.refusal
    assert live.note.endswith(".")


def test_edits_that_make_no_sense_are_left_to_the_journal(project: Project) -> None:
    wild = new_cap(1, uid="w", edit="e1", visible=[[1e12, 0.0, 0.0, 1e12, 5.0, 5.0]])
    elsewhere = new_cap(404, uid="x", edit="e2")
    deletion = Edit(id="e3", annotation="y", image=1, base=3, cap=None)
    good = new_cap(1, uid="z", edit="e4")
    found = derive_edits(project, [wild, elsewhere, deletion, good])
    assert [item.edit for item in found] == [wild, elsewhere, deletion, good]
    assert [item.fit.whole is None for item in found] == [True, True, True, False]


def bitten(x: float, y: float, r: float, front: tuple[float, float, float]) -> Outline:
    """The outline of a round cap that lies partly under another round one."""
    angles = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    rim = np.stack([x + r * np.cos(angles), y + r * np.sin(angles)], axis=1)
    away = rim - front[:2]
    far = np.maximum(np.hypot(*away.T), front[2])[:, None]
    return [(front[:2] + away / np.hypot(*away.T)[:, None] * far).ravel().tolist()]


FRONT = (80.0, 60.0, 20.0)
CROWD = [
    circle(*FRONT, points=60),
    bitten(55, 55, 18, FRONT),
    bitten(104, 64, 19, FRONT),
    bitten(82, 92, 17, FRONT),
    bitten(84, 30, 18, FRONT),
    circle(20, 100, 12),
]


SMALLER = circle(86, 62, 11, points=60)
"""The cap in front as somebody corrects it: it no longer explains what hides the others."""


@pytest.fixture
def crowded(project: Project) -> Project:
    """A project whose first image shows a heap of caps that a run saw, whole outlines and all."""

    def predict(connection: object) -> None:
        run = add_run(connection, name="later", kind="simulated")
        new = [NewPrediction(visible=cap, score=0.9, uid=str(n)) for n, cap in enumerate(CROWD)]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=new)

    project.write(predict)
    fill_in(project)
    return project


def accepted(prediction: Prediction, **changes: object) -> Edit:
    cap = Cap(**{"visible": prediction.visible, "prediction": prediction.id, **changes})
    return Edit(id=f"e{prediction.id}", annotation=f"a{prediction.id}", image=1, base=0, cap=cap)


def store(project: Project, edits: Sequence[Edit]) -> list[Annotation]:
    outcomes = commit(project, derive_edits(project, edits), user="Ada")
    return [outcome.annotation for outcome in outcomes]


def stored(cap: Prediction | Annotation) -> tuple[object, object]:
    return cap.whole, cap.centre


def test_predictions_accepted_as_they_are_keep_outline_and_centre_to_the_last_digit(
    crowded: Project,
) -> None:
    predictions = contents_of(crowded).predictions
    assert len(predictions) == len(CROWD)
    one_by_one = [store(crowded, [accepted(prediction)])[0] for prediction in predictions[:3]]
    together = store(crowded, [accepted(prediction) for prediction in predictions[3:]])
    assert [stored(cap) for cap in (*one_by_one, *together)] == [stored(cap) for cap in predictions]


def test_the_live_fit_of_an_untouched_prediction_is_what_is_stored_of_it(crowded: Project) -> None:
    caps = contents_of(crowded)
    for prediction in caps.predictions:
        edit = accepted(prediction)
        live = refit(caps, Refit(seq=1, image=1, annotation=f"prediction:{prediction.id}", cap=edit.cap))
        assert (live.fit.whole, live.fit.centre) == stored(prediction)


def test_accepting_next_to_a_corrected_cap_fits_anew_and_far_from_it_does_not(crowded: Project) -> None:
    front, beside, *_, far = contents_of(crowded).predictions
    store(crowded, [accepted(front, visible=SMALLER)])
    assert stored(store(crowded, [accepted(far)])[0]) == stored(far)
    moved = store(crowded, [accepted(beside)])[0]
    assert moved.centre != beside.centre
    assert moved.centre == pytest.approx(beside.centre, abs=2)


def test_an_edit_of_one_cap_leaves_what_is_stored_of_its_neighbours(crowded: Project) -> None:
    front, beside, *_ = contents_of(crowded).predictions
    neighbour = store(crowded, [accepted(beside)])[0]
    store(crowded, [accepted(front, visible=SMALLER)])
    cap = neighbour.cap
    flagged = Edit(
        id="flag", annotation=neighbour.uid, image=1, base=1, cap=msgspec.structs.replace(cap, doubtful=True)
    )
    caps = contents_of(crowded)
    assert stored(caps.annotations[neighbour.uid]) == stored(neighbour)
    live = refit(caps, Refit(seq=1, image=1, annotation=neighbour.uid, cap=flagged.cap))
    assert (live.fit.whole, live.fit.centre) == stored(neighbour)
    assert "fitted anew its centre would move" in live.note
    assert stored(store(crowded, [flagged])[0]) == stored(neighbour)


def test_a_cap_that_is_moved_and_moved_back_is_where_it_was(crowded: Project) -> None:
    front = contents_of(crowded).predictions[0]
    there = store(crowded, [accepted(front)])[0]
    x, y, r = FRONT
    for nth, outline in enumerate((circle(x + 3, y, r, points=60), front.visible), start=1):
        cap = Cap(visible=outline, prediction=front.id)
        edit = Edit(id=f"move{nth}", annotation=there.uid, image=1, base=nth, cap=cap)
        (moved,) = store(crowded, [edit])
        assert (stored(moved) == stored(there)) == (nth == 2)


def test_turning_down_a_prediction_takes_it_from_its_neighbours(crowded: Project) -> None:
    front, beside, *_ = contents_of(crowded).predictions
    made = accepted(front)
    gone = Edit(id="gone", annotation=made.annotation, image=1, base=1, cap=None)
    derived = derive_edits(crowded, [made, gone, accepted(beside)])
    commit(crowded, derived, user="Ada")
    caps = contents_of(crowded)
    assert f"prediction {front.id}" not in caps.visible
    (after,) = derive_edits(crowded, [new_cap(1, uid="again", visible=beside.visible, prediction=beside.id)])
    assert derived[2].fit.centre != beside.centre
    assert after.fit.centre == derived[2].fit.centre
