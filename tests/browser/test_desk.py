"""A reviewer decides from the keyboard: what is drawn, what is predicted, what is kept of it all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator
from playwright.sync_api import Error as NotThere

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.contents import load_annotations, load_predictions
from fairyring.storage.images import get_image
from fairyring.storage.project import open_project
from fairyring.storage.records import Annotation, GivenVerdict
from fairyring.storage.verdicts import verdicts_of
from tests.support.annotated_beds import CDR, make_annotated_beds, uid_of

OpenTab = Callable[..., Tab]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=3)


def said_of(project: Path, image: int) -> list[GivenVerdict]:
    with open_project(project) as opened, opened.read() as connection:
        return verdicts_of(connection, image)


def status_of(project: Path, image: int) -> str:
    with open_project(project) as opened, opened.read() as connection:
        return get_image(connection, image).status


def caps_of(project: Path, image: int) -> dict[str, Annotation]:
    with open_project(project) as opened, opened.read() as connection:
        return {each.uid: each for each in load_annotations(connection, image)}


def on_image(tab: Tab, number: int) -> None:
    tab.wait_for(f"window.fairyring.state.image.id === {number}")


def selected(tab: Tab, uid: str) -> None:
    tab.wait_for(f"window.fairyring.state.selection[0] === {uid!r}")


def say_yes(tab: Tab) -> None:
    """To the question about the prediction that nobody has decided upon."""
    tab.page.get_by_role("alertdialog").wait_for()
    tab.press("Tab", "Enter")


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
    tab.page.keyboard.type("The fifth cap is missing")
    tab.press("Enter")
    on_image(tab, 2)
    tab.page.get_by_text("Sent bed_1.png back: “The fifth cap is missing”. 2 to review.").wait_for()
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
    assert [(v.says, v.words) for v in said_of(project, 1)] == [("sent_back", "The fifth cap is missing")]
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


def test_ada_cannot_approve_her_own_work_until_the_project_allows_it(
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
    tab.press("p")
    on_image(tab, 1)
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


def open_queue(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Queue", exact=True).click()


def choose(tab: Tab, label: str, option: str) -> None:
    tab.page.get_by_label(label).first.click()
    tab.page.get_by_role("option", name=option).click()


def test_a_queue_is_gone_through_with_the_agreement_and_taken_up_again_after_a_reload(
    server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    open_queue(tab)
    tab.page.get_by_text("3 images wait for a review.").wait_for()
    tab.page.get_by_role("button", name="Begin").click()
    tab.page.get_by_text("0 of 3 done").wait_for()
    tab.press("Shift+Enter")
    say_yes(tab)
    on_image(tab, 2)
    tab.press("Shift+X")
    tab.page.keyboard.type("Out of focus")
    tab.press("Enter")
    on_image(tab, 3)
    # Wilson's interval of 1 in 2.
    tab.page.get_by_text("2 of 3 done, agreement 50 % (9 to 91 %)").wait_for()
    tab.page.reload()
    tab.wait_for("window.fairyring?.state.connection === 'online'")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("2 of 3 done, agreement 50 % (9 to 91 %)").wait_for()
    tab.page.get_by_role("button", name="End the queue").click()
    tab.page.get_by_text("1 image waits for a review.").wait_for()


def test_a_random_sample_that_passes_has_the_rest_approved(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "lot").mkdir()
    project = make_annotated_beds(tmp_path / "lot", count=12)
    server = Server(project)
    server.start()
    context = browser.new_context(viewport={"width": 1500, "height": 900})
    try:
        tab = Tab(context.new_page())
        tab.enter(server.url, name="Rev")
        open_queue(tab)
        choose(tab, "Queue by", "random sample")
        tab.page.get_by_text("12 of 12 images have to be looked at").wait_for()
        tab.page.get_by_label("Wrong at most %").fill("40")
        tab.press("Tab")
        # Five wrong of twelve: scipy.stats.hypergeom(12, 5, 5).cdf(0) is 0.027, of 4 it is 0.071.
        tab.page.get_by_text("5 of 12 images have to be looked at").wait_for()
        tab.page.get_by_role("button", name="Begin").click()
        tab.page.get_by_text("0 of 5 done").wait_for()
        for done in range(1, 6):
            tab.press("Shift+Enter")
            say_yes(tab)
            tab.page.locator(".fr-queue").get_by_text(f"{done} of 5 done").wait_for()
        tab.page.get_by_role("button", name="Approve the other 7").click()
        tab.page.get_by_text("7 images approved.").wait_for()
    finally:
        context.close()
        server.stop()
    assert [status_of(project, number) for number in range(1, 13)] == ["approved"] * 12
    words = {v.words for number in range(1, 13) for v in said_of(project, number)}
    assert words == {"", "By a sample: 0 of 5 wrong, 0 allowed"}


def test_the_worst_caps_of_all_images_and_what_is_counted_lead_to_the_caps(
    server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_role("button", name="Bring up to date").click()
    caps = tab.page.get_by_role("group", name="Caps of all images")
    caps.get_by_role("button", name="12 measured").wait_for()
    worst = caps.locator(".fr-gallery button")
    # Ada's second cap of each of the three images is the worst of its image.
    assert [worst.nth(n).get_attribute("data-fairyring-select") for n in range(3)] == [
        uid_of(image, 1) for image in (1, 2, 3)
    ]
    assert worst.first.locator("polygon").count() == 2
    assert worst.first.locator("line").count() == 1
    worst.nth(2).click()
    on_image(tab, 3)
    selected(tab, uid_of(3, 1))
    assert tab.state("review.on") is True
    tab.page.get_by_text("3 of 3 differences").wait_for()
    caps.get_by_role("button", name="3 missed").click()
    caps.get_by_text("1–3 of 3. Annotated, and not predicted.").wait_for()
    worst.first.click()
    selected(tab, uid_of(1, 4))
    caps.get_by_role("button", name="3 extra").click()
    caps.get_by_text("1–3 of 3. Predicted, and not annotated.").wait_for()
    worst.nth(1).click()
    on_image(tab, 2)
    tab.wait_for("window.fairyring.state.selection[0]?.startsWith('prediction:')")
    (turned_down,) = tab.state("selection")
    tab.press("Delete")
    tab.saved()
    # A page that is loaded anew knows of it, too.
    tab.page.reload()
    tab.wait_for("window.fairyring?.state.connection === 'online'")
    tab.page.get_by_role("tab", name="Review").click()
    caps.get_by_role("button", name="3 extra").click()
    caps.get_by_text("Predicted, and not annotated.").wait_for()
    worst.nth(1).click()
    selected(tab, turned_down)
    tab.page.get_by_text("extra: turned down").wait_for()
    card = tab.page.get_by_label("Selected cap")
    card.get_by_text(f"Prediction {turned_down.removeprefix('prediction:')}").wait_for()
    tab.press("s")
    tab.saved()
    assert len(tab.state("shapes")) == 6
    assert tab.page.get_by_role("button", name="Keep mine").count() == 0
    tab.press("Escape", "f", "c")
    # A circle around the cap that Ada drew, which is not selected, is a mark of that cap.
    drag(tab, (400.0, 300.0), (444.0, 300.0))
    selected(tab, uid_of(2, 4))
    tab.saved()
    assert len(tab.state("shapes")) == 6
    tab.press("Shift+Enter")
    tab.page.get_by_text("You have changed caps of bed_2.png").wait_for()


def drag(tab: Tab, start: tuple[float, float], end: tuple[float, float]) -> None:
    """From one point of the image to another."""
    tab.page.mouse.move(*tab.screen(start))
    tab.page.mouse.down()
    tab.page.mouse.move(*tab.screen(end), steps=4)
    tab.page.mouse.up()


def hover_until_named(tab: Tab, words: Locator, *, across: float) -> None:
    """Moves over the first plot until it names a point: one that is drawn anew has forgotten the pointer."""
    drawn = tab.page.locator(".u-over").first
    for _ in range(20):
        try:
            box = drawn.bounding_box(timeout=3000) or {"width": 0.0}
            drawn.hover(position={"x": across * box["width"], "y": 20}, timeout=3000)
            words.wait_for(timeout=1500)
        except NotThere:
            continue
        return
    raise AssertionError(f"The plot names no point {across:.0%} across")


def test_figures_can_be_grouped_kept_and_plotted_and_a_click_on_a_plot_opens_the_cap(
    server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_role("button", name="Bring up to date").click()
    plot = tab.page.get_by_role("group", name="CDR of each image, %")
    plot.wait_for()
    hover_until_named(tab, plot.get_by_text("2, bed_2.png: CDR"), across=0.5)
    hover_until_named(tab, plot.get_by_text("3, bed_3.png: CDR"), across=0.9)
    tab.page.mouse.down()
    tab.page.mouse.up()
    on_image(tab, 3)
    selected(tab, uid_of(3, 1))
    choose(tab, "Figures by", "annotator")
    groups = tab.page.get_by_role("table", name="Groups of caps")
    adas = groups.get_by_role("row", name="Ada")
    assert adas.inner_text().split()[3:] == ["12", "3", "3"]
    adas.get_by_role("button", name="3", exact=True).first.click()
    caps = tab.page.get_by_role("group", name="Caps of all images")
    caps.get_by_text("1–3 of 3. Annotated, and not predicted.").wait_for()
    caps.get_by_text("Only annotator: Ada").wait_for()
    bed_2 = tab.page.locator("tr:has([data-fairyring-by=image])", has_text="bed_2.png")
    bed_2.get_by_role("button", name="1", exact=True).last.click()
    caps.get_by_text("1–1 of 1. Predicted, and not annotated.").wait_for()
    caps.get_by_role("button", name="Show all").click()
    caps.get_by_text("1–3 of 3. Predicted, and not annotated.").wait_for()
    with tab.page.expect_download() as kept:
        plot.get_by_role("link", name="CSV").click()
    rows = kept.value.path().read_text().splitlines()
    assert [row.split(",")[0] for row in rows] == ["image", "bed_1.png", "bed_2.png", "bed_3.png"]
    svg = tab.page.request.get(f"{server.url}/review/shifts.svg").text()
    assert svg.startswith("<svg")
    assert svg.count('class="dot"') == 12
    report = tab.page.request.get(f"{server.url}/review/report.html?image=2").text()
    assert "(Table 4)" in report
    assert "bed_1.png" not in report
