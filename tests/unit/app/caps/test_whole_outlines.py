"""Whole outlines and centres, from marks and from what is visible."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.app.caps.image_caps import Scene, scene_of
from fairyring.app.caps.nearby import Boxes, box_of, keys_near
from fairyring.app.caps.whole_outlines import derive_edits, fill_in, refit, whole_of
from fairyring.app.protocol import Refit
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon, diameter_of_shape
from fairyring.storage.contents import load_annotations, load_contents
from fairyring.storage.derived import images_with_underived
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Cap, Edit, Image
from tests.support.tab import SQUARE, new_cap
from tests.unit.app.conftest import circle

IMAGE = Image(id=1, file_name="a.jpg", path="a.jpg", width=160, height=120, sha256="")
SCENE = Scene(IMAGE, {}, [])


def test_a_mark_is_its_own_whole_outline() -> None:
    for mark in (Circle(50, 40, 10), Ellipse(50, 40, 12, 10, 30)):
        whole = whole_of("a", Cap(visible=SQUARE, mark=mark), SCENE)
        assert whole.shape == mark
        assert whole.centre == (50, 40)


def test_a_marked_polygon_gives_the_ellipse_fitted_to_its_points() -> None:
    whole = whole_of("a", Cap(visible=[], mark=Polygon(circle(60, 50, 20, points=20)[0])), SCENE)
    assert whole.centre == pytest.approx((60, 50), abs=1e-6)
    assert "polygon" in whole.note


def test_a_round_cap_is_found_where_it_is() -> None:
    whole = whole_of("a", Cap(visible=circle(70.25, 55.5, 24)), SCENE)
    assert whole.centre == pytest.approx((70.25, 55.5), abs=0.1)
    assert whole.shape is not None
    assert diameter_of_shape(whole.shape) == pytest.approx(48, abs=1)


@pytest.mark.parametrize(
    "visible", [[], [[]], [[1.0, 2.0]], [[1.0, 2.0, 3.0]], [[1e12, 0.0, 0.0, 1e12, -1e12, 0.0]], [[5.0] * 8]]
)
def test_a_wild_outline_gives_a_sentence_and_never_reaches_the_rasteriser(visible: list) -> None:
    whole = whole_of("a", Cap(visible=visible), SCENE)
    assert whole.shape is None
    assert whole.note.endswith(".")


@pytest.mark.parametrize("mark", [Circle(50, 40, -1), Circle(1e12, 0, 5), Polygon([1.0, 2.0, 3.0])])
def test_a_wild_mark_gives_a_sentence(mark: Circle | Polygon) -> None:
    assert whole_of("a", Cap(visible=SQUARE, mark=mark), SCENE).shape is None


def test_neighbours_are_those_whose_boxes_touch() -> None:
    boxes = Boxes()
    others = {"touching": circle(80, 40, 20), "far": circle(150, 40, 5), "nothing": []}
    assert keys_near(circle(40, 40, 20), others, boxes=boxes) == ["touching"]
    assert keys_near(circle(40, 40, 20), others, reach=3.0, boxes=boxes) == ["touching", "far"]
    assert keys_near([], others, boxes=boxes) == []
    assert box_of(SQUARE) == (20.0, 20.0, 60.0, 60.0)


def test_context_leaves_out_predictions_that_somebody_took_up(project: Project) -> None:
    with project.read() as connection:
        contents = load_contents(connection, 1)
    left, right = contents.predictions
    commit(project, [Derived(edit=new_cap(1, prediction=left.id))], user="Ada")
    with project.read() as connection:
        annotations = {a.uid: a for a in load_annotations(connection, 1)}
    scene = Scene(contents.image, annotations, contents.predictions)
    assert set(scene.visible) == {"cap-1", f"prediction {right.id}"}


def test_a_refit_says_what_the_edit_will_store(project: Project) -> None:
    cap = Cap(visible=circle(90, 70, 18))
    with project.read() as connection:
        contents = load_contents(connection, 1)
    fit = refit(scene_of(contents), Refit(seq=1, image=1, annotation="a", cap=cap))
    stored = derive_edits(project, [Edit(id="e", annotation="a", image=1, base=0, cap=cap)])[0]
    assert fit.whole == stored.whole
    assert fit.centre == stored.centre


def test_a_refit_tells_the_arcs_of_an_outline_apart_and_how_well_the_centre_is_known() -> None:
    whole, cut = circle(70, 55, 24), circle(4, 60, 24)
    cut[0][0::2] = [max(x, 0.0) for x in cut[0][0::2]]
    free, bordered = (
        refit(SCENE, Refit(seq=1, image=1, annotation="a", cap=Cap(visible=outline)))
        for outline in (whole, cut)
    )
    assert [arc.kind for arc in free.arcs] == ["visible"]
    around = np.reshape(free.arcs[0].points, (-1, 2))
    assert np.hypot(*(around - (70, 55)).T) == pytest.approx(24, abs=1.0)
    assert sorted(arc.kind for arc in bordered.arcs) == ["border", "visible"]
    border = next(arc for arc in bordered.arcs if arc.kind == "border")
    assert max(border.points[0::2]) < 2
    assert free.centre_sd is not None
    assert bordered.centre_sd is not None
    assert 0 < free.centre_sd[0] < bordered.centre_sd[0]
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
    scene = Scene(IMAGE, {"front": front}, [])
    cap = Cap(visible=[bitten.ravel().tolist()])
    fit = refit(scene, Refit(seq=1, image=1, annotation="a", cap=cap))
    assert fit.centre == pytest.approx((60, 60), abs=0.5)
    hidden = [arc for arc in fit.arcs if arc.kind == "hidden"]
    assert len(hidden) == 1
    seam = np.reshape(hidden[0].points, (-1, 2))
    assert np.hypot(*(seam - (90, 60)).T) == pytest.approx(24, abs=1.5)


def test_a_mark_has_no_arcs_and_no_doubt_about_its_centre() -> None:
    cap = Cap(visible=SQUARE, mark=Circle(50, 40, 10))
    fit = refit(SCENE, Refit(seq=1, image=1, annotation="a", cap=cap))
    assert (fit.arcs, fit.centre_sd, fit.note) == ([], None, "the marked circle")


def test_a_refit_of_a_wild_outline_says_why_there_is_none() -> None:
    fit = refit(SCENE, Refit(seq=1, image=1, annotation="a", cap=Cap(visible=[[1.0, 2.0]])))
    assert (fit.whole, fit.centre, fit.arcs) == (None, None, [])
    assert fit.note.endswith(".")


def test_edits_that_make_no_sense_are_left_to_the_journal(project: Project) -> None:
    wild = new_cap(1, uid="w", edit="e1", visible=[[1e12, 0.0, 0.0, 1e12, 5.0, 5.0]])
    elsewhere = new_cap(404, uid="x", edit="e2")
    deletion = Edit(id="e3", annotation="y", image=1, base=3, cap=None)
    good = new_cap(1, uid="z", edit="e4")
    found = derive_edits(project, [wild, elsewhere, deletion, good])
    assert [item.edit for item in found] == [wild, elsewhere, deletion, good]
    assert [item.whole is None for item in found] == [True, True, True, False]


def test_filling_in_finds_what_is_missing_and_then_nothing_more(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2, mark=Circle(30, 30, 9)))], user="Ada")
    seen: list[tuple[int, int, str]] = []
    assert fill_in(project, progress=lambda *step: seen.append(step)) == 3
    assert [step[:2] for step in seen] == [(0, 2), (1, 2)]
    with project.read() as connection:
        assert images_with_underived(connection) == []
        marked = load_annotations(connection, 2)[0]
        left, right = load_contents(connection, 1).predictions
    assert marked.centre == (30, 30)
    assert left.centre == pytest.approx((40, 40), abs=0.25)
    assert right.centre == pytest.approx((110, 60), abs=0.25)
    assert fill_in(project) == 0


def test_filling_in_can_be_stopped_between_images(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2))], user="Ada")

    def stop(done: int, _total: int, _what: str) -> None:
        if done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fill_in(project, progress=stop)
    with project.read() as connection:
        assert images_with_underived(connection) == [2]
