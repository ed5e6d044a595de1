"""Caps of all images side by side: the worst, and those counted as missed, extra, doubtful or unsure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.close_up import close_up
from fairyring.app.panels.counted import counted, of_group
from fairyring.app.panels.markup import Markup, element
from fairyring.app.review.groups import NOT_KNOWN, words_of
from fairyring.storage.cap_groups import By, Group, number_of
from fairyring.storage.compared_caps import KINDS, CapFigures, Kind, count_caps, list_caps
from fairyring.storage.contents import load_annotation, load_prediction
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Annotation, Image, Prediction
from fairyring.storage.runs import get_run

PAGE = 12
WORDS: dict[Kind, str] = {
    "worst": "measured",
    "matched": "matched",
    "missed": "missed",
    "extra": "extra",
    "doubtful": "doubtful",
    "unsure": "unsure marks",
    "ignored": "ignored",
}
ABOUT: dict[Kind, str] = {
    "worst": "CDR / floor of its mark; furthest above its floor first.",
    "matched": "Annotated and predicted; unmarked ones have no CDR.",
    "missed": "Annotated, and not predicted.",
    "extra": "Predicted, and not annotated.",
    "doubtful": "A careful person could disagree.",
    "unsure": "Their marks hardly determine a centre.",
    "ignored": "They count neither way.",
}
ABOUT_SECOND: dict[Kind, str] = {
    "worst": "Between their centres / floor of the first’s mark; furthest above its floor first.",
    "matched": "The annotations and {} have it; unmarked ones have no CDR.",
    "missed": "In the annotations, and not in {}.",
    "extra": "In {}, and not in the annotations.",
}
"""The same of caps that are compared with a second annotator's version, ``{}``."""

BY_WORDS: dict[By, str] = {
    "light": "light",
    "form": "form",
    "size": "size",
    "visibility": "visible share",
    "shape": "kind of mark",
    "annotator": "annotator",
    "image": "image",
    "run": "run",
}


@dataclass(frozen=True)
class Thumbnail:
    """A cap of the gallery with what is drawn of it."""

    image: Image
    figures: CapFigures
    annotation: Annotation | None
    prediction: Prediction | None


@dataclass(frozen=True, kw_only=True)
class Shown:
    """What the gallery shows."""

    kind: Kind
    group: Group | None = None
    """Only caps of this group; None for all images."""
    name: str = ""
    """What the group is called."""
    second: str | None = None
    """The second annotator's version that its caps are compared with, None for a model's."""

    def about(self, kind: Kind) -> str:
        """Which caps these are."""
        if self.second is None or kind not in ABOUT_SECOND:
            return ABOUT[kind]
        return ABOUT_SECOND[kind].replace("{}", self.second)

    counts: Mapping[Kind, int] = field(default_factory=lambda: dict.fromkeys(KINDS, 0))
    page: int = 0
    thumbnails: Sequence[Thumbnail] = ()


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the gallery of the latest run."""
    gui = session.client.gui
    shown = gui.add_html("")
    pages = gui.add_button_group("Caps", ("‹", "›"), visible=False)
    page, of_those = [0], [(session.gallery, session.gallery_group)]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.refresh("gallery")

    async def redraw() -> None:
        kind, group = session.gallery, session.gallery_group
        if of_those[0] != (kind, group):
            of_those[0], page[0] = (kind, group), 0
        found = await workspace.read(partial(_find, kind=kind, group=group, wanted=page[0]))
        page[0] = found.page
        shown.content = gallery(found).html
        pages.visible = found.counts[kind] > PAGE

    pages.on_click(person_did(session, turn))
    return redraw


def _find(connection: Connection, *, kind: Kind, group: Group | None, wanted: int) -> Shown:
    """The page asked for, or the last one."""
    run = latest_run(connection)
    if run is None:
        return Shown(kind=kind)
    counts = count_caps(connection, run.id, group=group)
    page = min(wanted, max(counts[kind] - 1, 0) // PAGE)
    found = list_caps(connection, run.id, kind, group=group, offset=page * PAGE, limit=PAGE)
    return Shown(
        kind=kind,
        group=group,
        name="" if group is None else _name_of(connection, group),
        second=_second_of(connection, group),
        counts=counts,
        page=page,
        thumbnails=[_thumbnail(connection, each) for each in found],
    )


def _name_of(connection: Connection, group: Group) -> str:
    with suppress(StoreError):  # an image may have been taken out meanwhile
        if group.by == "image":
            return get_image(connection, number_of(group) or 0).file_name
        if group.by == "run":
            return _name_of_run(connection, group)
    return f"{BY_WORDS[group.by]}: {words_of(group.value or NOT_KNOWN)}"


def _second_of(connection: Connection, group: Group | None) -> str | None:
    """The second annotator's version that the caps of a group are compared with."""
    with suppress(StoreError):
        if group is not None and group.by == "run":
            return get_run(connection, number_of(group) or 0).second_annotator
    return None


def _name_of_run(connection: Connection, group: Group) -> str:
    """Against which run, on which images. Raises StoreError where one of them is gone."""
    name = f"against {get_run(connection, number_of(group) or 0).name}"
    if group.image is not None:
        return f"{name}, of {get_image(connection, group.image).file_name}"
    if group.beside is not None:
        return f"{name}, of images compared with {get_run(connection, group.beside).name}, too"
    return name


def _thumbnail(connection: Connection, figures: CapFigures) -> Thumbnail:
    said = None if figures.annotation is None else load_annotation(connection, figures.annotation)
    guessed = None if figures.prediction is None else load_prediction(connection, figures.prediction)
    return Thumbnail(get_image(connection, figures.image), figures, said, guessed)


def gallery(found: Shown) -> Markup:
    """The counts, each leading to what it counts, and a page of close-ups."""
    if not any(found.counts.values()) and found.group is None:
        return element("div", class_="fr-review")
    first = found.page * PAGE + 1
    last, total = first + len(found.thumbnails) - 1, found.counts[found.kind]
    counts = f"{first}–{last} of {total}. " if found.thumbnails else "None. "
    return element(
        "div",
        element("h3", "Caps of all images", class_="fr-heading"),
        _group_line(found),
        element("div", *(_count(each, found) for each in KINDS), class_="fr-kinds"),
        element("div", *map(_figure, found.thumbnails), class_="fr-gallery"),
        element("div", counts + found.about(found.kind), class_="fr-quiet"),
        class_="fr-review",
        role="group",
        aria_label="Caps of all images",
    )


def _group_line(found: Shown) -> Markup | None:
    """Of which group the caps are, and a way back to those of all images."""
    if found.group is None:
        return None
    return element(
        "div",
        element("span", f"Only {found.name}"),
        counted(found.kind, "Show all"),
        class_="fr-line",
    )


def _count(kind: Kind, found: Shown) -> Markup:
    return element(
        "button",
        f"{found.counts[kind]} {WORDS[kind]}",
        type="button",
        title=found.about(kind),
        aria_pressed="true" if kind == found.kind else "false",
        data_fairyring_gallery=kind,
        **of_group(found.group),
    )


def _figure(each: Thumbnail) -> Markup:
    figures, outline = each.figures, each.annotation or each.prediction
    if outline is None:
        return element("div", "gone", class_="fr-quiet")
    said = "–" if figures.cdr is None else f"{figures.cdr:.2f} %"
    floor = "–" if figures.floor is None else f"{figures.floor:.2f}"
    told = f"{each.image.file_name}: CDR {said}, its mark alone {floor} %"
    select = figures.annotation or f"prediction:{figures.prediction}"
    return element(
        "button",
        close_up(each.image, each.annotation, each.prediction),
        element("span", "" if figures.cdr is None else f"{figures.cdr:.2f} / {floor} %"),
        type="button",
        title=told,
        aria_label=f"Open {told}",
        data_fairyring_open=each.image.id,
        data_fairyring_select=select,
        data_fairyring_run=figures.run,
        data_fairyring_differences=True,
    )
