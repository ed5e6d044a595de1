"""An annotator corrects caps: by pointer and keys, seen on disk."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab, centroid
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import area_of_outline
from tests.support.kept import journal_of, kept_cap, live_caps

CORNERS = [(12.0, 12.0), (52.0, 10.0), (58.0, 40.0), (30.0, 55.0), (8.0, 38.0)]


def a_free_prediction(tab: Tab) -> dict:
    """The prediction of the most vertices whose box touches no other's."""
    predictions = tab.state("predictions")
    boxes = [_box(p["cap"]["visible"]) for p in predictions]
    return max(
        (
            p
            for p, box in zip(predictions, boxes, strict=True)
            if not any(_overlap(box, other) for other in boxes if other is not box)
        ),
        key=lambda p: len(p["cap"]["visible"][0]),
    )


def _box(visible: list[list[float]]) -> tuple[float, float, float, float]:
    xs = [x for part in visible for x in part[0::2]]
    ys = [y for part in visible for y in part[1::2]]
    return min(xs), min(ys), max(xs), max(ys)


def _overlap(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def promote(tab: Tab) -> str:
    """Accepts a prediction and returns the uid of the annotation it became."""
    tab.select(centroid(a_free_prediction(tab)["cap"]["visible"][0]))
    tab.press("a")
    tab.wait_for("window.fairyring.state.shapes.length > 0")
    tab.saved()
    return tab.state("shapes")[-1]["uid"]


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def test_the_page_shows_a_photo_with_predictions_and_nothing_corrected(tab: Tab) -> None:
    assert len(tab.state("predictions")) > 20
    assert tab.state("shapes") == []
    tab.page.get_by_text("predicted by lite0").first.wait_for()


def test_the_page_says_so_where_the_file_is_another_photo(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    photo = project / "images" / tab.state("image.file_name")
    photo.write_bytes(photo.read_bytes() + b" ")

    again = open_tab(server)

    again.page.get_by_text(f"{photo.name} is no longer the photo that was imported").first.wait_for()


def test_accepting_a_prediction_makes_it_an_annotation(tab: Tab, project: Path) -> None:
    prediction = a_free_prediction(tab)
    uid = promote(tab)
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["visible"] == prediction["cap"]["visible"]
    assert kept["centre_x"] is not None


def test_a_selected_cap_tells_its_arcs_and_its_doubt_and_goes_on_telling_while_dragged(tab: Tab) -> None:
    prediction = a_free_prediction(tab)
    part = prediction["cap"]["visible"][0]
    tab.select(centroid(part))
    tab.wait_for("window.fairyring.state.fit")
    fit = tab.state("fit")
    assert fit["annotation"] == prediction["uid"]
    assert {arc["kind"] for arc in fit["arcs"]} <= {"visible", "hidden", "border", "concave"}
    assert all(0 < sd < 20 for sd in fit["fit"]["centre_sd"])
    tab.page.get_by_text(fit["note"]).wait_for()
    corner, middle = (part[0], part[1]), centroid(part)
    way = tuple(at + 0.2 * (at - centre) for at, centre in zip(corner, middle, strict=True))
    tab.page.mouse.move(*tab.screen(corner))
    tab.page.mouse.down()
    tab.page.mouse.move(*tab.screen(way), steps=6)
    tab.wait_for(f"window.fairyring.state.fit && window.fairyring.state.fit.seq > {fit['seq']}")
    tab.page.mouse.up()
    tab.saved()
    tab.wait_for("window.fairyring.state.fit?.annotation === window.fairyring.state.selection[0]")
    tab.press("m")
    tab.press("Escape")
    assert tab.state("fit") is None


def test_predictions_accepted_as_they_are_keep_outline_and_centre(tab: Tab, project: Path) -> None:
    said = {p["cap"]["prediction"]: (p["whole"], p["centre"]) for p in tab.state("predictions")}
    promote(tab)
    tab.press("Escape")
    tab.accept_all()
    tab.wait_for("window.fairyring.state.predictions.length === 0")
    tab.saved()
    shown = {s["cap"]["prediction"]: (s["whole"], s["centre"]) for s in tab.state("shapes")}
    assert shown == said
    kept = [kept_cap(project, uid) for uid in live_caps(project)]
    assert {k["prediction"]: (k["whole"], [k["centre_x"], k["centre_y"]]) for k in kept if k} == said


def draw_outline(tab: Tab) -> str:
    """Draws a cap of five corners on bare soil by clicks and returns its uid."""
    tab.press("w")
    for corner in CORNERS:
        tab.click(corner)
    tab.press("Enter")
    tab.wait_for("window.fairyring.state.shapes.length === 1")
    tab.saved()
    return tab.state("shapes")[0]["uid"]


def test_a_dragged_vertex_is_on_disk_where_it_was_dropped(tab: Tab, project: Path) -> None:
    uid = draw_outline(tab)
    tab.press("v")
    tab.select(centroid([value for corner in CORNERS for value in corner]))
    tab.drag(CORNERS[0], (5.0, 20.0))
    tab.saved()
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["revision"] == 2
    moved = [value for corner in [(5.0, 20.0), *CORNERS[1:]] for value in corner]
    assert kept["visible"][0] == pytest.approx(moved, abs=1.5)


def test_a_vertex_dragged_with_alt_moves_alone_in_a_dense_outline(tab: Tab, project: Path) -> None:
    uid = promote(tab)
    shape = tab.shape(uid)
    assert shape is not None
    part = shape["cap"]["visible"][0]
    tab.select(centroid(part))
    tab.press("z")
    tab.page.keyboard.down("Alt")
    tab.drag((part[0], part[1]), (part[0] + 9.0, part[1] - 6.0))
    tab.page.keyboard.up("Alt")
    tab.saved()
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["visible"][0][2:] == part[2:]
    assert kept["visible"][0][:2] == pytest.approx((part[0] + 9.0, part[1] - 6.0), abs=1.0)


def test_the_centre_follows_while_a_vertex_is_dragged(tab: Tab) -> None:
    uid = promote(tab)
    shape = tab.shape(uid)
    assert shape is not None
    part, before = shape["cap"]["visible"][0], shape["centre"]
    tab.select(centroid(part))
    x, y = tab.screen((part[0], part[1]))
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 40, y + 40, steps=8)
    moved = f"window.fairyring.state.shapes.find(s => s.uid === {uid!r}).centre"
    tab.wait_for(f"{moved} && Math.hypot({moved}[0] - {before[0]}, {moved}[1] - {before[1]}) > 0.2")
    assert tab.state("waiting") == 0, "nothing is sent before the button is released"
    tab.page.mouse.up()
    tab.saved()


def test_a_cap_drawn_by_clicks_is_on_disk(tab: Tab, project: Path) -> None:
    uid = draw_outline(tab)
    assert live_caps(project) == [uid]
    kept = kept_cap(project, uid)
    assert kept is not None
    drawn = [value for corner in CORNERS for value in corner]
    assert kept["visible"][0] == pytest.approx(drawn, abs=1.0)
    assert kept["centre_x"] == pytest.approx(32.0, abs=6.0)


def test_a_circle_dragged_from_the_centre_of_a_cap_is_its_mark(tab: Tab, project: Path) -> None:
    uid = promote(tab)
    shape = tab.shape(uid)
    assert shape is not None
    x, y = centroid(shape["cap"]["visible"][0])
    tab.select((x, y))
    tab.press("c")
    tab.drag((x, y), (x + 25.0, y))
    tab.saved()
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["mark"]["kind"] == "circle"
    assert (kept["mark"]["cx"], kept["mark"]["cy"]) == pytest.approx((x, y), abs=1.0)
    assert kept["mark"]["r"] == pytest.approx(25.0, abs=1.0)
    assert (kept["centre_x"], kept["centre_y"]) == (kept["mark"]["cx"], kept["mark"]["cy"])
    assert kept["visible"] == shape["cap"]["visible"]


def test_a_circle_dragged_on_bare_soil_is_a_new_cap(tab: Tab, project: Path) -> None:
    tab.press("c")
    tab.drag((30.0, 30.0), (48.0, 30.0))
    tab.wait_for("window.fairyring.state.shapes.length === 1")
    tab.saved()
    [uid] = live_caps(project)
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["mark"]["r"] == pytest.approx(18.0, abs=1.0)
    assert area_of_outline(kept["visible"]) == pytest.approx(math.pi * 18**2, rel=0.15)


def test_a_deleted_prediction_is_gone_after_a_reload(tab: Tab, project: Path) -> None:
    prediction = a_free_prediction(tab)
    count = len(tab.state("predictions"))
    tab.select(centroid(prediction["cap"]["visible"][0]))
    tab.press("Delete")
    tab.wait_for(f"window.fairyring.state.predictions.length === {count - 1}")
    tab.saved()
    assert live_caps(project) == []
    tab.reload()
    assert len(tab.state("predictions")) == count - 1


def test_undo_and_redo_are_edits_on_disk(tab: Tab, project: Path) -> None:
    uid = promote(tab)
    shape = tab.shape(uid)
    assert shape is not None
    part = shape["cap"]["visible"][0]
    tab.select(centroid(part))
    tab.press("ArrowRight", "ArrowRight", "ArrowRight", "ArrowRight")
    tab.saved()
    moved = kept_cap(project, uid)
    assert moved is not None
    assert moved["visible"][0][0] == pytest.approx(part[0] + 1.0)

    tab.press("Control+z")
    tab.saved()
    undone = kept_cap(project, uid)
    assert undone is not None
    assert undone["visible"][0] == pytest.approx(part)

    tab.press("Control+Shift+z")
    tab.saved()
    redone = kept_cap(project, uid)
    assert redone is not None
    assert redone["visible"][0] == pytest.approx(moved["visible"][0])
    assert [edit["revision"] for edit in journal_of(project, uid)] == list(range(1, redone["revision"] + 1))
    assert {edit["user"] for edit in journal_of(project, uid)} == {"Ada"}


def test_the_key_list_opens_with_a_question_mark_and_closes_with_escape(tab: Tab) -> None:
    tab.press("?")
    tab.page.get_by_role("dialog").wait_for()
    assert "Undo" in tab.page.get_by_role("dialog").inner_text()
    tab.press("Escape")
    tab.page.get_by_role("dialog").wait_for(state="hidden")
