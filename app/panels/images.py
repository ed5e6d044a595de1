"""The list of images: search, filters, order, a page at a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.addresses import photo_address
from fairyring.app.live.session import Session
from fairyring.app.live.taking_out import put_back_last, take_out_shown
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels import splits
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.panels.status import SAID_WORDS, STATUS_OF_WORD, status_badge
from fairyring.model.light_and_form import FORMS, LIGHTS
from fairyring.model.splits import Split
from fairyring.storage.images import (
    ImageFilter,
    ImagePage,
    ImageRow,
    ListPosition,
    list_images,
    position_in_list,
)
from fairyring.storage.records import Says
from fairyring.storage.taken_out import taken_out
from fairyring.storage.verdicts import given_back

PAGE = 10
ANY = "any"
SAID_OF_WORD: dict[str, Says] = {word: says for says, word in SAID_WORDS.items()}
NOTHING_SAID: Mapping[int, Says] = {}
ORDERS = {
    "name": ImageFilter(),
    "name, Z first": ImageFilter(descending=True),
    "newest first": ImageFilter(sort="added", descending=True),
    "most caps first": ImageFilter(sort="caps", descending=True),
    "worst CDR first": ImageFilter(sort="cdr", descending=True),
    "most to gain first": ImageFilter(sort="gain"),
}


@dataclass
class _Shown:
    """Which page is shown, and the image it was last moved to."""

    page: int = 0
    image: int | None = None


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the filters and the list, which turns to the page of the image on screen when that changes."""
    gui, at = session.client.gui, _Shown()
    search = gui.add_text("Search", "", hint="Part of a file name")
    with gui.add_folder("Filter and order", expand_by_default=False):
        status = gui.add_dropdown("Status", (ANY, *STATUS_OF_WORD, *SAID_OF_WORD))
        light = gui.add_dropdown("Light", (ANY, *LIGHTS))
        form = gui.add_dropdown("Form", (ANY, *FORMS))
        split = gui.add_dropdown("Split", (ANY, *Split, splits.NONE))
        order = gui.add_dropdown("Order", tuple(ORDERS))
    shown = gui.add_html("")
    pages = gui.add_button_group("Page", ("«", "‹", "›", "»"))
    redraw_splits = splits.build(workspace, session)
    out = gui.add_button(
        "Take this image out", hint="With its labels; until the project is closed it can be put back"
    )
    back = gui.add_button("Put back", visible=False)

    async def filter_changed() -> None:
        ordered = ORDERS[order.value]
        session.filter = ImageFilter(
            search=search.value.strip(),
            status=STATUS_OF_WORD.get(status.value),
            given_back=SAID_OF_WORD.get(status.value),
            light=_chosen(light.value),
            form=_chosen(form.value),
            split="" if split.value == splits.NONE else _chosen(split.value),
            sort=ordered.sort,
            descending=ordered.descending,
        )
        at.page = 0
        session.refresh("images", "status")

    async def turn() -> None:
        last = 10**9
        at.page = {"«": 0, "‹": max(at.page - 1, 0), "›": at.page + 1, "»": last}[pages.value]
        session.refresh("images")

    async def redraw() -> None:
        kept = await anyio.to_thread.run_sync(taken_out, workspace.project)
        back.visible = bool(kept)
        back.label = f"Put back {kept[0].file_name}" if kept else "Put back"
        here = session.image.id if session.image else None
        wanted = at.page if here == at.image else None
        find = partial(_find, which=session.filter, here=here, wanted=wanted)
        at.page, page, position, said = await workspace.read(find)
        at.image = here
        if position is not None and here not in session.queue:
            session.position, session.count = position.position, position.count
        session.refresh("status")
        shown.content = image_list(page, at.page, here, said).html
        await redraw_splits()

    for control in (search, status, light, form, split, order):
        control.on_update(person_did(session, filter_changed))
    pages.on_click(person_did(session, turn))
    out.on_click(person_did(session, partial(take_out_shown, workspace, session)))
    back.on_click(person_did(session, partial(put_back_last, workspace, session)))
    return redraw


def _chosen(value: str) -> str | None:
    """The value of a filter's control; None where any will do."""
    return None if value == ANY else value


def _find(
    connection: Connection, *, which: ImageFilter, here: int | None, wanted: int | None
) -> tuple[int, ImagePage, ListPosition | None, dict[int, Says]]:
    """The number of a page, the page, where the image on screen stands, and which images were given back.

    The page ``wanted``, or the last one if there are fewer; None asks for the one with the image on screen.
    """
    at = None if here is None else position_in_list(connection, which, here)
    if wanted is None:
        wanted = 0 if at is None else at.position // PAGE
    page = list_images(connection, which, offset=wanted * PAGE, limit=PAGE)
    last = max(page.total - 1, 0) // PAGE
    if wanted > last:
        wanted, page = last, list_images(connection, which, offset=last * PAGE, limit=PAGE)
    return wanted, page, at, given_back(connection, [row.image.id for row in page.rows])


def image_list(
    page: ImagePage, number: int, current: int | None, said: Mapping[int, Says] = NOTHING_SAID
) -> Markup:
    """A page of the list with what was last said of its images; the row of the one on screen stands out."""
    if not page.rows:
        return element("div", "No image fits these filters.", class_="fr-images fr-quiet")
    first = number * PAGE + 1
    counted = f"{first}–{first + len(page.rows) - 1} of {page.total} images"
    head = element(
        "tr",
        element("th", width=68),
        element("th", "Image"),
        element("th", "Caps", class_="fr-number", width=48),
        element("th", "CDR %", class_="fr-number", width=64),
    )
    rows = (_row(row, said.get(row.image.id), current=row.image.id == current) for row in page.rows)
    return element(
        "div",
        element("table", element("thead", head), element("tbody", *rows), class_="fr-list"),
        element("div", counted, class_="fr-quiet"),
        class_="fr-images",
    )


def _row(row: ImageRow, said: Says | None, *, current: bool) -> Markup:
    image = row.image
    thumbnail = element("img", src=f"{photo_address(image)}?w=160", alt="", loading="lazy")
    caps = element("span", row.caps, title=f"{row.ignored} ignored, {row.predicted} predicted")
    name = element("span", image.file_name, class_="fr-ellipsis", title=image.file_name)
    status = status_badge(image, said)
    known = (image.light, image.form and f"form {image.form}", image.split)
    facts = " · ".join(fact for fact in known if fact)
    return element(
        "tr",
        element("td", thumbnail),
        element("td", name, element("div", status, " ", element("span", facts, class_="fr-quiet"))),
        element("td", caps, class_="fr-number"),
        element("td", *_cdr(row), class_="fr-number"),
        data_fairyring_open=image.id,
        aria_current="true" if current else None,
        tabindex=0,
        role="button",
    )


def _cdr(row: ImageRow) -> tuple[Content, ...]:
    """Mean CDR with the floor of the marks below it."""
    if row.cdr_mean is None:
        return ("–",)
    floor = "–" if row.floor_mean is None else f"{row.floor_mean:.2f}"
    told = "What the marks are off by themselves"
    return f"{row.cdr_mean:.2f}", element("div", f"floor {floor}", class_="fr-quiet", title=told)
