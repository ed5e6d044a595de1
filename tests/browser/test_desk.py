"""A reviewer decides from the keyboard: what is drawn, what is predicted, what is kept of it all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.contents import load_predictions
from fairyring.storage.project import open_project
from tests.support.annotated_beds import CDR, make_annotated_beds, uid_of
from tests.support.desk import caps_of, on_image, said_of, say_yes, selected, status_of

OpenTab = Callable[..., Tab]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=3)


def test_differences_are_walked_through_decided_and_the_image_approved_by_keys_alone(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    with open_project(project) as opened, opened.read() as connection:
        said = load_predictions(connection, 1)
    tab = open_tab(server, name="Rev")
    tab.press(".")
    selected(tab, uid_of(1, 4))
    tab.press("u")  # nobody predicted it, and it is right
    selected(tab, f"prediction:{said[4].id}")
    tab.press("s")  # predicted, and left open
    selected(tab, uid_of(1, 1))
    compared = next(each for each in tab.state("review.caps") if each["annotation"] == uid_of(1, 1))
    assert compared["cdr"] == pytest.approx(CDR, abs=0.01)
    assert compared["prediction"]["id"] == said[1].id
    tab.press("s")  # the mark is 8 px off
    tab.saved()
    tab.press("Shift+Enter")
    on_image(tab, 2)
    tab.saved()
    caps = caps_of(project, 1)
    assert len(caps) == 6
    assert (caps[uid_of(1, 1)].cap.mark, caps[uid_of(1, 1)].cap.visible) == (None, said[1].visible)
    assert said[4].id in {each.cap.prediction for each in caps.values()}
    assert [(v.user, v.says, v.annotation) for v in said_of(project, 1)] == [
        ("Rev", "approved", uid_of(1, 4)),
        ("Rev", "approved", None),
    ]
    assert status_of(project, 1) == "approved"


def test_an_image_is_sent_back_with_a_comment_another_rejected_with_a_reason(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.press("Shift+R")
    tab.page.get_by_role("textbox", name="What is to be done about it?").wait_for()
    tab.page.keyboard.type("2 caps are missing")
    tab.press("Enter")
    on_image(tab, 2)
    tab.page.get_by_text("Sent bed_1.png back: “2 caps are missing”. 2 to review.").wait_for()
    tab.press("Shift+X")
    asked = tab.page.get_by_role("dialog", name="Reject bed_2.png: why?")
    asked.get_by_role("textbox", name="Why is it rejected?").wait_for()
    tab.press("Enter")
    asked.get_by_text("Say why first: press 1 to 5, or write it.").wait_for()
    asked.get_by_role("button", name="Cancel Esc").click()
    asked.wait_for(state="detached")
    tab.press("Shift+X", "1")
    asked.get_by_role("button", name="Reject the image Enter").click()
    on_image(tab, 3)
    tab.saved()
    assert [(v.says, v.words) for v in said_of(project, 1)] == [("sent_back", "2 caps are missing")]
    assert [(v.says, v.words) for v in said_of(project, 2)] == [("rejected", "Out of focus")]
    assert (status_of(project, 1), status_of(project, 2)) == ("new", "new")
    tab.press("p")
    on_image(tab, 2)
    card = tab.page.get_by_label("Selected cap")
    card.get_by_text("Rev rejected: Out of focus").wait_for()
    tab.page.locator(".fr-header").get_by_text("✗ rejected").wait_for()
    tab.page.locator(".fr-images tr", has_text="bed_1.png").get_by_text("↩ sent back").wait_for()
    tab.page.get_by_role("tab", name="Review").click()
    said = tab.page.get_by_label("Said of this image")
    said.get_by_text("Rev rejected: Out of focus").wait_for()
    decided = tab.page.locator(".fairyring-notice", has_text="Rejected bed_2.png: “Out of focus”.")
    decided.get_by_role("button", name="Undo").click()
    tab.page.get_by_text("Taken back: bed_2.png is annotated again.").wait_for()
    tab.saved()
    assert status_of(project, 2) == "annotated"


def test_what_was_said_of_a_cap_is_taken_back_by_undo_and_what_is_decided_stays_so_on_coming_back(
    project: Path, watched: Tab
) -> None:
    tab = watched
    tab.press("u")
    tab.page.get_by_text("2 of 3 differences").wait_for()
    tab.press("Control+z")
    selected(tab, uid_of(1, 4))
    tab.page.get_by_text("Taken back: what you said of a cap.").wait_for()
    tab.page.get_by_text("1 of 3 differences").wait_for()
    tab.press("u", "s", "s")
    tab.page.get_by_text("All 3 differences decided").wait_for()
    tab.press("n")
    on_image(tab, 2)
    tab.press("p")
    on_image(tab, 1)
    tab.page.get_by_text("All 3 differences decided").wait_for()
    tab.saved()
    assert [(v.says, v.annotation) for v in said_of(project, 1)] == [
        (says, uid_of(1, 4)) for says in ("approved", "withdrawn", "approved")
    ]


def test_what_was_said_of_a_cap_is_taken_back_also_after_a_reload(project: Path, watched: Tab) -> None:
    tab = watched
    tab.press("u")
    tab.saved()
    tab.reload()
    tab.press("Control+z")
    tab.page.get_by_text("Taken back: what you said of a cap.").wait_for()
    selected(tab, uid_of(1, 4))
    tab.saved()
    assert [v.says for v in said_of(project, 1)] == ["approved", "withdrawn"]


def test_who_takes_back_a_rejection_in_the_history_can_approve(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.press("Shift+X", "1", "Enter")
    on_image(tab, 2)
    tab.press("p")
    on_image(tab, 1)
    tab.page.get_by_label("Selected cap").get_by_text("Rev rejected: Out of focus").wait_for()
    tab.page.get_by_role("tab", name="History").click()
    tab.page.get_by_role("button", name="Take back").first.click()
    tab.page.get_by_text("Rev rejected: Out of focus").wait_for(state="detached")
    tab.press("Shift+Enter")
    say_yes(tab)
    on_image(tab, 2)
    tab.saved()
    assert [v.says for v in said_of(project, 1)] == ["rejected", "withdrawn", "approved"]


def test_a_comment_on_a_cap_leads_back_to_the_cap(project: Path, server: Server, open_tab: OpenTab) -> None:
    tab = open_tab(server, name="Rev")
    tab.press(".")
    selected(tab, uid_of(1, 4))
    tab.press("Shift+C")
    tab.page.get_by_role("textbox", name="Comment").wait_for()
    tab.page.keyboard.type("<b>Is it one?</b>")
    tab.press("Enter")
    tab.saved()
    (verdict,) = said_of(project, 1)
    assert (verdict.says, verdict.annotation, verdict.revision) == ("comment", uid_of(1, 4), 1)
    tab.press("Escape")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("<b>Is it one?</b>").wait_for()
    tab.page.get_by_role("button", name="Show the cap").click()
    selected(tab, uid_of(1, 4))


def test_ada_cannot_approve_her_own_work_and_stays_on_it_until_the_project_allows_it(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Ada")
    tab.press("Shift+Enter")
    say_yes(tab)
    tab.page.get_by_text("You have labelled bed_1.png").wait_for()
    assert status_of(project, 1) == "annotated"
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Rules of this project").click()
    allowed = tab.page.get_by_label("Approve own work")
    # A click waits until what unfolds no longer moves; one that is forced goes astray.
    allowed.click()
    tab.page.wait_for_timeout(500)
    assert tab.state("image")["id"] == 1
    tab.press("Shift+Enter")
    say_yes(tab)
    on_image(tab, 2)
    tab.saved()
    assert status_of(project, 1) == "approved"


def test_a_verdict_given_while_the_server_is_away_is_kept_and_sent_when_it_is_back(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    server.kill()
    tab.wait_for("window.fairyring.state.connection === 'offline'")
    tab.press("Shift+C")
    tab.page.get_by_role("textbox", name="Comment").wait_for()
    tab.page.keyboard.type("Said in the dark")
    tab.press("Enter")
    tab.wait_for("window.fairyring.state.waiting === 1")
    server.start()
    tab.page.bring_to_front()
    tab.saved()
    assert [v.words for v in said_of(project, 1)] == ["Said in the dark"]


@pytest.fixture
def watched(server: Server, open_tab: OpenTab) -> Tab:
    tab = open_tab(server, name="Rev")
    tab.press(".")
    selected(tab, uid_of(1, 4))
    return tab


def test_outlines_take_turns_and_errors_are_enlarged_on_request(watched: Tab) -> None:
    watched.press("y")
    assert watched.state("review.times") == 10
    watched.press("y")
    assert watched.state("review.times") == 1
    watched.press("Shift+L")
    watched.wait_for("window.fairyring.state.review.turn === 'prediction'")
    watched.wait_for("window.fairyring.state.review.turn === 'annotation'")
    watched.press("Shift+L")
    assert watched.state("review.turn") is None
    watched.press("Shift+D")
    assert watched.state("review.on") is False
