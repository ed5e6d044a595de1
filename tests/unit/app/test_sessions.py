"""Tabs: tokens, what is shown, edits, refits, conflicts, and that tabs never mix."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed

from app.gateway.messages import (
    Changed,
    Edits,
    Fit,
    Hello,
    Layers,
    Notice,
    Open,
    Outcomes,
    Refit,
    Select,
    SetStatus,
    Show,
    Step,
    Toggle,
    Welcome,
)
from model.geometry import Circle
from storage.project import Project
from storage.records import Accepted, Cap, Conflict, Edit, Refused
from tests.unit.app.conftest import circle
from tests.unit.app.tab import Panel, Tab, new_cap, open_socket, until


def test_a_tab_is_welcomed_and_shown_the_first_image(port: int, project: Project) -> None:
    with Tab(port, name="Åsa") as tab:
        assert tab.expect(Welcome) == Welcome(user="Åsa", project=project.id)
        shown = tab.expect(Show)
        assert shown.document.image.file_name == "bed_1.jpg"
        assert (shown.position, shown.count) == (0, 3)
        assert len(shown.document.predictions) == 2
        assert shown.document.run.kind == "simulated"
        assert shown.photo.startswith("/photos/1/")
        assert [url.split("/")[2] for url in shown.ahead] == ["2"]


def test_a_token_is_good_once(port: int) -> None:
    panel = Panel(port, name="Ada")
    token = panel.token
    first = open_socket(port, "/editor")
    first.send(msgspec.json.encode(Hello(token=token)).decode())
    assert "welcome" in first.recv(5)
    second = open_socket(port, "/editor")
    second.send(msgspec.json.encode(Hello(token=token)).decode())
    with pytest.raises(ConnectionClosed) as closed:
        second.recv(5)
    assert closed.value.rcvd.code == 4403
    first.close()
    fresh = until(lambda: panel.token != token and panel.token, "a fresh token for the same tab")
    third = open_socket(port, "/editor")
    third.send(msgspec.json.encode(Hello(token=fresh)).decode())
    assert "welcome" in third.recv(5)


@pytest.mark.parametrize("first", ["{}", "[]", "nonsense", '{"type":"hello"}', '{"type":"open","image":1}'])
def test_a_socket_that_does_not_say_hello_is_closed(shared_port: int, first: str) -> None:
    stranger = open_socket(shared_port, "/editor")
    stranger.send(first)
    with pytest.raises(ConnectionClosed) as closed:
        stranger.recv(5)
    assert closed.value.rcvd.code == 4403


def test_the_editor_is_let_go_when_its_tab_disconnects(port: int) -> None:
    tab = Tab(port)
    tab.expect(Show)
    tab.panel.socket.close()
    assert tab.close_code() == 4410


def test_a_tab_comes_back_to_its_image_after_a_restart(serve: Callable[..., int]) -> None:
    with Tab(serve(), image=2) as tab:
        assert tab.expect(Show).document.image.id == 2
    with Tab(serve(), image=99) as tab:
        assert tab.expect(Notice).level == "warning"
        assert tab.expect(Show).document.image.id == 1


def test_two_tabs_stay_on_images_of_their_own(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bodil Ek", image=2) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1, uid="a", edit="e1"))
        bo.edit(new_cap(2, uid="b", edit="e2"))
        assert ada.nothing_more(Changed)
        assert bo.nothing_more(Changed)
        ada.send(Open(image=3))
        assert ada.expect(Show).document.image.id == 3
        assert bo.nothing_more(Show)
        assert "Bodil Ek" not in ada.panel.html
        until(lambda: "bed_2.jpg" in bo.panel.html)


def test_others_on_the_same_image_see_an_edit_and_its_author_does_not_see_it_twice(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1))
        seen = bo.expect(Changed)
        assert (seen.user, seen.image, [a.uid for a in seen.annotations]) == ("Ada", 1, ["cap-1"])
        assert ada.nothing_more(Changed)


def test_an_edit_is_acknowledged_only_after_it_is_in_the_file(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as tab:
        tab.expect(Show)
        for number in range(5):
            outcome = tab.edit(new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}")).outcomes[0]
            with sqlite3.connect(f"file:{project.folder / 'project.db'}?mode=ro", uri=True) as other:
                row = other.execute("SELECT annotation, user FROM edit WHERE id = ?", [f"edit-{number}"])
                assert row.fetchone() == (f"cap-{number}", "Ada")
            assert isinstance(outcome, Accepted)
            assert outcome.annotation.revision == 1


def test_an_edit_brings_its_centre_and_whole_outline(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        marked = new_cap(2, uid="m", edit="e1", mark=Circle(cx=41.25, cy=38.5, r=20.0))
        plain = new_cap(2, uid="p", edit="e2", visible=circle(110, 70, 25))
        by_mark, by_fit = (outcome.annotation for outcome in tab.edit(marked, plain).outcomes)
        assert by_mark.centre == (41.25, 38.5)
        assert by_mark.whole == Circle(cx=41.25, cy=38.5, r=20.0)
        assert by_fit.centre == pytest.approx((110.0, 70.0), abs=0.25)


def test_the_same_edit_again_is_accepted_again_and_stored_once(port: int, project: Project) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        first = tab.edit(new_cap(1))
        assert tab.edit(new_cap(1)) == first
    with sqlite3.connect(project.folder / "project.db") as database:
        assert database.execute("SELECT count(*) FROM edit").fetchone() == (1,)


def test_a_lost_update_is_a_conflict_that_names_who_was_first(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1))
        ada.edit(new_cap(1, edit="edit-2", base=1, doubtful=True))
        conflict = bo.edit(new_cap(1, edit="edit-3", base=1, ignored=True)).outcomes[0]
        assert isinstance(conflict, Conflict)
        assert conflict.user == "Ada"
        assert conflict.theirs.revision == 2
        assert conflict.theirs.cap.doubtful


@pytest.mark.parametrize(
    ("cap", "word"),
    [
        ({"visible": [[1.0, 1.0, 2.0, 2.0]]}, "point"),
        ({"visible": [[1e9, 0.0, 0.0, 1e9, 5.0, 5.0]]}, ""),
        ({"category": "cat"}, "categor"),
        ({"prediction": 12345}, "prediction"),
    ],
)
def test_an_edit_that_makes_no_sense_is_refused_in_a_sentence(port: int, cap: dict, word: str) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        refused, accepted = tab.edit(new_cap(1, **cap), new_cap(1, uid="good", edit="good")).outcomes
        assert isinstance(refused, Refused)
        assert word in refused.reason
        assert refused.reason.endswith(".")
        assert isinstance(accepted, Accepted)


def test_edits_that_cannot_be_read_are_refused_by_name_and_the_socket_stays_open(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.editor.send('{"type":"edits","edits":[{"id":"e1","cap":{"visible":[["NaN"]]}}]}')
        refused = tab.expect(Outcomes).outcomes
        assert [(type(o), o.edit) for o in refused] == [(Refused, "e1")]
        tab.editor.send("}{")
        assert tab.expect(Notice).level == "error"
        assert isinstance(tab.edit(new_cap(1)).outcomes[0], Accepted)


def test_an_edit_of_an_image_that_is_not_there_is_refused(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        assert isinstance(tab.edit(new_cap(77)).outcomes[0], Refused)


def test_accepting_a_prediction_keeps_where_it_came_from(port: int) -> None:
    with Tab(port, image=1) as tab:
        prediction = tab.expect(Show).document.predictions[0]
        cap = Cap(visible=prediction.visible, prediction=prediction.id)
        outcome = tab.edit(Edit(id="e", annotation="a", image=1, base=0, cap=cap)).outcomes[0]
        assert outcome.annotation.cap.prediction == prediction.id


def refit_request(seq: int, x: float) -> Refit:
    """Of a round cap around (x, 40), on an image without other caps, where every method agrees."""
    return Refit(seq=seq, image=2, annotation="cap-1", cap=Cap(visible=circle(x, 40, 20)))


def test_a_refit_answers_with_the_centre_of_the_outline_it_was_asked_about(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(refit_request(7, 50.0))
        fit = tab.expect(Fit)
        assert (fit.seq, fit.annotation) == (7, "cap-1")
        assert fit.centre == pytest.approx((50.0, 40.0), abs=0.2)
        assert fit.note


def test_of_many_refits_the_latest_wins_and_most_are_never_computed(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        for seq in range(1, 101):
            tab.send(refit_request(seq, 40.0 + seq / 10))
        answers = []
        while not answers or answers[-1].seq != 100:
            answers.append(tab.expect(Fit))
        assert answers[-1].centre == pytest.approx((50.0, 40.0), abs=0.2)
        assert [fit.seq for fit in answers] == sorted(fit.seq for fit in answers)
        assert len(answers) < 100
        assert tab.nothing_more(Fit)


def test_a_refit_of_an_image_no_longer_shown_is_dropped(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.send(refit_request(1, 30.0))
        assert tab.nothing_more(Fit)


def test_steps_follow_the_list_and_stop_at_its_ends(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.send(Step(by=-1))
        assert "first image" in tab.expect(Notice).text
        for expected in (2, 3):
            tab.send(Step(by=1))
            assert tab.expect(Show).document.image.id == expected
        tab.send(Step(by=1))
        assert "last image" in tab.expect(Notice).text


def test_steps_follow_the_filter(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.panel.set("Search", "BED_3")
        until(lambda: "1–1 of 1 images" in tab.panel.html, "the filtered list")
        tab.send(Step(by=1))
        shown = tab.expect(Show)
        assert (shown.document.image.id, shown.position, shown.count) == (3, 0, 1)


def test_a_status_is_stored_with_its_author_and_every_list_follows(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=2) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(SetStatus(image=1, status="approved"))
        until(lambda: "fr-badge fr-approved" in ada.panel.html)
        until(lambda: "fr-badge fr-approved" in bo.panel.html)
        with sqlite3.connect(project.folder / "project.db") as database:
            row = database.execute("SELECT before, after, user FROM status_change").fetchone()
        assert row == ("new", "approved", "Ada")


def test_a_layer_key_and_the_panel_agree(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.send(Toggle(layer="label"))
        assert tab.expect(Layers).visible["label"] is True
        tab.panel.set("Brightness", 2.0)
        layers = tab.expect(Layers)
        assert layers.brightness == 2.0
        assert layers.visible["label"] is True
        tab.panel.set("2  Visible outlines", False)
        assert tab.expect(Layers, lambda m: not m.visible["outline"]).visible["label"] is True


def test_an_image_that_is_gone_is_a_notice_and_nothing_else_changes(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(Open(image=404))
        notice = tab.expect(Notice)
        assert notice.level == "error"
        assert "404" in notice.text
        tab.send(Select(annotation="cap-1"))
        tab.send(Step(by=1))
        assert tab.expect(Show).document.image.id == 3


def test_numbers_beyond_the_database_do_no_harm(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        for image in (2**63, -1, 0):
            tab.send(Open(image=image))
            assert tab.expect(Notice).level == "error"
        assert isinstance(tab.edit(new_cap(1)).outcomes[0], Accepted)


def test_thirty_changes_in_a_row_are_all_answered_in_order(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        started = time.monotonic()
        for number in range(30):
            tab.send(Edits(edits=[new_cap(1, edit=f"e{number}", base=number)]))
        revisions = [tab.expect(Outcomes).outcomes[0].annotation.revision for _ in range(30)]
        assert revisions == list(range(1, 31))
        assert time.monotonic() - started < 10
