"""What tests of the reviewer's desk ask of the page and of the store."""

from __future__ import annotations

from pathlib import Path

from fairyring.app.bench.browser.tab import Tab
from fairyring.storage.contents import load_annotations
from fairyring.storage.images import get_image
from fairyring.storage.project import open_project
from fairyring.storage.records import Annotation, GivenVerdict
from fairyring.storage.verdicts import verdicts_of


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


def choose(tab: Tab, label: str, option: str) -> None:
    tab.page.get_by_label(label).first.click()
    tab.page.get_by_role("option", name=option).click()
