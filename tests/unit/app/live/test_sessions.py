"""Tabs: tokens, what is shown, and that tabs never mix."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed

from fairyring.app.protocol import (
    Changed,
    Edits,
    Hello,
    Notice,
    Open,
    Outcomes,
    Select,
    Show,
    StatusChanged,
    Step,
    Tag,
    Welcome,
)
from fairyring.storage.project import Project
from fairyring.storage.records import Accepted, Refused, StatusEdit, StatusStored
from tests.support.tab import Panel, Tab, new_cap, open_socket, until


def test_a_tab_is_welcomed_and_shown_the_first_image(port: int, project: Project) -> None:
    with Tab(port, name="Åsa") as tab:
        assert tab.expect(Welcome) == Welcome(user="Åsa", project=project.id)
        shown = tab.expect(Show)
        assert shown.contents.image.file_name == "bed_1.jpg"
        assert (shown.position, shown.count) == (0, 3)
        assert len(shown.contents.predictions) == 2
        assert shown.contents.run.kind == "simulated"
        assert shown.photo.startswith("/photos/1/")
        assert [url.split("/")[2] for url in shown.ahead] == ["2"]


def test_a_tab_is_told_where_the_network_is_not_to_look_ahead(serve: Callable[..., int]) -> None:
    with Tab(serve(look_ahead=False), name="Ada") as tab:
        assert not tab.expect(Welcome).look_ahead


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
        assert tab.expect(Show).contents.image.id == 2
    with Tab(serve(), image=99) as tab:
        assert tab.expect(Notice).level == "warning"
        assert tab.expect(Show).contents.image.id == 1


def test_two_tabs_stay_on_images_of_their_own(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bodil Ek", image=2) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1, uid="a", edit="e1"))
        bo.edit(new_cap(2, uid="b", edit="e2"))
        assert ada.nothing_more(Changed)
        assert bo.nothing_more(Changed)
        ada.send(Open(image=3))
        assert ada.expect(Show).contents.image.id == 3
        assert bo.nothing_more(Show)
        assert "Bodil Ek" not in ada.panel.html
        until(lambda: "bed_2.jpg" in bo.panel.html)


def test_steps_follow_the_list_and_stop_at_its_ends(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.send(Step(by=-1))
        assert "first image" in tab.expect(Notice).text
        for expected in (2, 3):
            tab.send(Step(by=1))
            assert tab.expect(Show).contents.image.id == expected
        tab.send(Step(by=1))
        assert "last image" in tab.expect(Notice).text


def test_steps_follow_the_filter(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.panel.set("Search", "BED_3")
        until(lambda: "1–1 of 1 images" in tab.panel.html, "the filtered list")
        tab.send(Step(by=1))
        shown = tab.expect(Show)
        assert (shown.contents.image.id, shown.position, shown.count) == (3, 0, 1)


def approval(number: str) -> StatusEdit:
    return StatusEdit(id=number, image=1, before="new", after="approved")


def test_everybody_on_the_image_hears_of_its_status_and_a_second_opinion_is_refused(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(Edits(edits=[], statuses=[approval("s1")]))
        told = StatusChanged(image=1, status="approved", user="Ada")
        assert (ada.expect(StatusChanged), bo.expect(StatusChanged)) == (told, told)
        bo.send(Edits(edits=[], statuses=[approval("s2")]))
        sentence = "Ada has set bed_1.jpg to “approved” meanwhile; it stays so."
        assert bo.expect(Outcomes).outcomes == [Refused(edit="s2", reason=sentence)]


def test_an_edit_of_an_approved_image_reopens_it_for_everybody(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(Edits(edits=[], statuses=[approval("s1")]))
        for tab in (ada, bo):
            assert tab.expect(StatusChanged).status == "approved"
        bo.edit(new_cap(1))
        reopened = StatusChanged(image=1, status="annotated", user="Bo")
        assert ada.expect(StatusChanged) == reopened
        assert reopened in bo.received


def test_a_status_is_stored_with_its_author_and_every_list_follows(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=2) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(Edits(edits=[], statuses=[approval("s1")]))
        assert ada.expect(Outcomes).outcomes == [StatusStored(edit="s1", image=1, status="approved")]
        until(lambda: "fr-badge fr-approved" in ada.panel.html)
        until(lambda: "fr-badge fr-approved" in bo.panel.html)
        with sqlite3.connect(project.folder / "project.db") as database:
            row = database.execute("SELECT before, after, user FROM status_change").fetchone()
        assert row == ("new", "approved", "Ada")


def test_light_and_form_are_stored_and_told_to_every_tab(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(Tag(image=1, light="side", form="c"))
        until(lambda: "side · form c" in bo.panel.html)
        with sqlite3.connect(project.folder / "project.db") as database:
            row = database.execute("SELECT light, form FROM image WHERE id = 1").fetchone()
        assert row == ("side", "c")
        ada.send(Tag(image=1, light="moon", form=None))
        assert "none of top, side, dark" in ada.expect(Notice).text


def test_a_split_is_stored_shown_in_the_list_and_offered_with_the_tags(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.send(Tag(image=1, light="side", split="val"))
        until(lambda: "side · val" in bo.panel.html and '<option value="val" selected' in bo.panel.html)
        with sqlite3.connect(project.folder / "project.db") as database:
            assert database.execute("SELECT split FROM image WHERE id = 1").fetchone() == ("val",)
        ada.send(Tag(image=1, light="side", split=None))
        until(lambda: "side · val" not in bo.panel.html)


def test_the_panel_counts_and_averages_what_is_selected(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.edit(new_cap(1, uid="cap-1", edit="e1"), new_cap(1, uid="cap-2", edit="e2", doubtful=True))
        tab.send(Select(annotations=["cap-1", "cap-2"]))
        until(lambda: "2 selected" in tab.panel.html)
        assert "1 of 2" in tab.panel.html


def test_an_image_that_is_gone_is_a_notice_and_nothing_else_changes(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(Open(image=404))
        notice = tab.expect(Notice)
        assert notice.level == "error"
        assert "404" in notice.text
        tab.send(Select(annotations=["cap-1"]))
        tab.send(Step(by=1))
        assert tab.expect(Show).contents.image.id == 3


def test_numbers_beyond_the_database_do_no_harm(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        for image in (2**63, -1, 0):
            tab.send(Open(image=image))
            assert tab.expect(Notice).level == "error"
        assert isinstance(tab.edit(new_cap(1)).outcomes[0], Accepted)
