"""Caps of all images side by side: the worst, and those counted as missed, extra, doubtful or unsure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.close_up import close_up
from fairyring.app.panels.markup import Markup, element
from fairyring.storage.compared_caps import KINDS, CapFigures, Kind, count_caps, list_caps
from fairyring.storage.contents import load_annotation, load_prediction
from fairyring.storage.images import get_image
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Annotation, Image, Prediction

PAGE = 12
WORDS: dict[Kind, str] = {
    "worst": "measured",
    "missed": "missed",
    "extra": "extra",
    "doubtful": "doubtful",
    "unsure": "unsure marks",
    "ignored": "ignored",
}
ABOUT: dict[Kind, str] = {
    "worst": "CDR / floor of its mark; furthest above its floor first.",
    "missed": "Annotated, and not predicted.",
    "extra": "Predicted, and not annotated.",
    "doubtful": "A careful person could disagree.",
    "unsure": "Their marks hardly determine a centre.",
    "ignored": "They count neither way.",
}


@dataclass(frozen=True)
class Thumbnail:
    """A cap of the gallery with what is drawn of it."""

    image: Image
    figures: CapFigures
    annotation: Annotation | None
    prediction: Prediction | None


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the gallery of the latest run."""
    gui = session.client.gui
    shown = gui.add_html("")
    pages = gui.add_button_group("Caps", ("‹", "›"), visible=False)
    page, of_kind = [0], [session.gallery]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.refresh("gallery")

    async def redraw() -> None:
        if of_kind[0] != session.gallery:
            of_kind[0], page[0] = session.gallery, 0
        find = partial(_find, kind=session.gallery, wanted=page[0])
        counts, page[0], thumbnails = await workspace.read(find)
        shown.content = gallery(session.gallery, counts, thumbnails, number=page[0]).html
        pages.visible = counts[session.gallery] > PAGE

    pages.on_click(person_did(session, turn))
    return redraw


def _find(
    connection: Connection, *, kind: Kind, wanted: int
) -> tuple[Mapping[Kind, int], int, list[Thumbnail]]:
    """How many caps of each kind there are; the page asked for, or the last one, with its number."""
    run = latest_run(connection)
    if run is None:
        return dict.fromkeys(KINDS, 0), 0, []
    counts = count_caps(connection, run.id)
    page = min(wanted, max(counts[kind] - 1, 0) // PAGE)
    found = list_caps(connection, run.id, kind, offset=page * PAGE, limit=PAGE)
    return counts, page, [_thumbnail(connection, each) for each in found]


def _thumbnail(connection: Connection, figures: CapFigures) -> Thumbnail:
    said = None if figures.annotation is None else load_annotation(connection, figures.annotation)
    guessed = None if figures.prediction is None else load_prediction(connection, figures.prediction)
    return Thumbnail(get_image(connection, figures.image), figures, said, guessed)


def gallery(kind: Kind, counts: Mapping[Kind, int], thumbnails: list[Thumbnail], *, number: int) -> Markup:
    """The counts, each leading to what it counts, and a page of close-ups."""
    if not any(counts.values()):
        return element("div", class_="fr-review")
    first = number * PAGE + 1
    counted = f"{first}–{first + len(thumbnails) - 1} of {counts[kind]}. " if thumbnails else "None. "
    return element(
        "div",
        element("h3", "Caps of all images", class_="fr-heading"),
        element("div", *(_count(each, counts[each], kind) for each in KINDS), class_="fr-kinds"),
        element("div", *map(_figure, thumbnails), class_="fr-gallery"),
        element("div", counted + ABOUT[kind], class_="fr-quiet"),
        class_="fr-review",
        role="group",
        aria_label="Caps of all images",
    )


def _count(kind: Kind, count: int, shown: Kind) -> Markup:
    return element(
        "button",
        f"{count} {WORDS[kind]}",
        type="button",
        title=ABOUT[kind],
        aria_pressed="true" if kind == shown else "false",
        data_fairyring_gallery=kind,
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
        data_fairyring_differences=True,
    )
