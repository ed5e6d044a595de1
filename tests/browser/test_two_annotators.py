"""A second annotator's labels of the same photo, held against the annotations at the reviewer's desk."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator, expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import open_project
from tests.support.annotated_beds import RADIUS, make_annotated_beds, uid_of
from tests.support.choosing import choose
from tests.support.plain_bed import SIZE, ring

BENS = ((80, 80), (360, 80), (500, 100), (400, 300), (600, 400))
"""Three of the caps that Ada accepted, the one that she drew, and one that she has not.

They are all on the first photo. He did not see the second, and found nothing on the third.
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    path = make_annotated_beds(tmp_path, count=3)
    caps = [
        {"id": n, "image_id": 1, "category_id": 1, "segmentation": [ring(x, y, RADIUS)]}
        | {"circle": [x, y, RADIUS], "center": [x, y], "doubt": n == 1}
        for n, (x, y) in enumerate(BENS, start=1)
    ]
    images = [
        {"id": number, "file_name": f"bed_{number}.png", "width": SIZE[0], "height": SIZE[1]}
        for number in (1, 3)
    ]
    bens = tmp_path / "ben.json"
    categories = [{"id": 1, "name": "mushroom"}]
    bens.write_text(json.dumps({"images": images, "annotations": caps, "categories": categories}))
    with open_project(path) as opened:
        import_paths(opened, [bens], as_=ImportAs.second)
    return path


def compare_all_with_ben(tab: Tab) -> Locator:
    """Takes his version beside the annotations; the table of both."""
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two annotators", exact=True).click()
    choose(tab, "Second annotator", "ben.json")
    tab.page.get_by_role("button", name="Compare all images with this version").click()
    return tab.page.get_by_role("table", name="Two annotators", exact=True)


def test_two_annotators_of_a_photo_are_compared_and_the_second_version_is_drawn(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    table = compare_all_with_ben(tab)
    for row in (
        "matched 4 4",
        "missed by the second 1 6",
        "only the second has (extra) 1 1",
        "IoU 1.000 1.000",
        # Ben alone doubts one of four: they agree no more often than by chance.
        "kappa of doubtful 0.00 0.00",
    ):
        table.get_by_role("row", name=row, exact=True).wait_for()
    # Ada took three centres as predicted, which the fit has within a tenth of a pixel.
    table.get_by_role("row", name=re.compile(r"^between centres, px 0\.0\d 0\.0\d$")).wait_for()
    # Its six caps: four of both, and one of each.
    tab.wait_for("window.fairyring.state.review.caps.length === 6")
    tab.page.get_by_text("Two runs side by side", exact=True).click()
    on_photo = tab.page.get_by_role("combobox", name="On the photo", exact=True)
    expect(on_photo).to_have_value("ben.json")
    on_photo.click()
    tab.page.get_by_role("option", name="the latest of each image", exact=True).click()
    expect(tab.page.get_by_role("combobox", name="Second annotator", exact=True)).to_have_value("nobody else")
    on_photo.click()
    tab.page.get_by_role("option", name="ben.json", exact=True).last.click()
    table.wait_for()
    tab.press("n")
    tab.page.get_by_text("ben.json holds nothing of this photo.").wait_for()
    images = tab.page.get_by_role("table", name="Images of two annotators")
    images.get_by_role("row", name=re.compile("^bed_1.png 1 1 1.000")).wait_for()
    images.get_by_role("row", name="bed_3.png 5 0 – –").wait_for()
    tab.press("n")
    table.get_by_role("row", name="missed by the second 5 6", exact=True).wait_for()
    images.get_by_role("button", name="bed_1.png", exact=True).click()
    tab.wait_for("window.fairyring.state.image.id === 1")


def test_every_number_of_two_annotators_leads_to_the_caps_that_it_counts(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    table = compare_all_with_ben(tab)
    caps = tab.page.get_by_role("group", name="Caps of all images")
    shown = caps.locator(".fr-gallery button")
    both, only_ben = "The annotations and ben.json have it", "In ben.json, and not in the annotations."
    only_ada = "In the annotations, and not in ben.json."
    for row, counts in (
        ("matched", (f"1–4 of 4. {both}", f"1–4 of 4. {both}")),
        ("IoU", (f"1–4 of 4. {both}", f"1–4 of 4. {both}")),
        ("only the second has (extra)", (f"1–1 of 1. {only_ben}", f"1–1 of 1. {only_ben}")),
        ("missed by the second", (f"1–1 of 1. {only_ada}", f"1–6 of 6. {only_ada}")),
    ):
        numbers = table.get_by_role("row", name=row).get_by_role("button")
        expect(numbers).to_have_count(2, timeout=30_000)
        for column in (1, 0):
            words = "Only against ben.json" + ("" if column else ", of bed_1.png")
            numbers.nth(column).click()
            caps.get_by_text(words, exact=True).wait_for()
            caps.get_by_text(counts[column]).wait_for()
    # Ben left out the second cap of Ada's.
    shown.first.click()
    tab.wait_for(f"window.fairyring.state.selection[0] === {uid_of(1, 1)!r}")
    tab.page.get_by_text("missed: ben.json has no such cap").first.wait_for()
    tab.page.get_by_label("Selected cap").get_by_text("ben.json has no such cap").wait_for()
    the_second_annotator_is_named_wherever_it_is_about_theirs(tab)
    bed_1 = tab.page.get_by_role("table", name="Images of two annotators").get_by_role(
        "row", name="bed_1.png"
    )
    bed_1.get_by_role("button", name="1", exact=True).last.click()
    caps.get_by_text("1–1 of 1. In ben.json, and not in the annotations.").wait_for()
    caps.get_by_role("button", name="Show all").click()
    caps.get_by_text("Only against").wait_for(state="detached")


def the_second_annotator_is_named_wherever_it_is_about_theirs(tab: Tab) -> None:
    strip, desk = tab.page.locator(".fairyring-review"), tab.page.get_by_role("group", name="Review")
    for words in ("first annotator’s", "second annotator’s: ben.json", "S Second’s", "U First’s"):
        strip.get_by_text(words, exact=True).wait_for()
    desk.get_by_role("button", name="S Second’s").wait_for()
    desk.get_by_role("button", name="U First’s").wait_for()
    for title in (
        "Take the second annotator’s, ben.json: the outline with its mark, the cap, or no cap (S)",
        "Take the first annotator’s: approve the cap, turn down what ben.json alone has (U)",
        "Show what was drawn and what ben.json has, or not (Shift+D)",
    ):
        desk.get_by_title(title, exact=True).wait_for()
    expect(desk.get_by_text("Model’s")).to_have_count(0, timeout=30_000)
    card = tab.page.get_by_label("Selected cap")
    tab.press(",")
    card.get_by_text("Second annotator’s cap").wait_for()
    strip.get_by_text("extra: only ben.json has it").wait_for()
    expect(card.get_by_text("Score")).to_have_count(0, timeout=30_000)
    card.get_by_role("button", name="Second’s").click()
    tab.saved()
    tab.page.get_by_role("tab", name="History").click()
    tab.page.get_by_text("Rev accepted a cap of ben.json").wait_for()
    tab.press("Control+z")
    tab.saved()
    tab.page.get_by_role("tab", name="Review").click()
