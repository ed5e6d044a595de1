"""Annotations against predictions: figures of all images and of groups of them, and image by image."""

from __future__ import annotations

from functools import partial

from fairyring.app.jobs.comparing import compare_work
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.review_found import GROUPS, ORDERS, PAGE, Wanted, find_review
from fairyring.app.panels.review_tables import review_figures, review_page

FIRST = -1.0
"""Place in the page before all that has no other."""


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the review of the latest run."""
    gui = session.client.gui
    figures = gui.add_html("", order=FIRST)
    shown = gui.add_html("")
    compare = gui.add_button("Bring up to date", visible=False)
    order = gui.add_dropdown("Order", tuple(ORDERS))
    by = gui.add_dropdown("Figures by", tuple(GROUPS))
    only_sure = gui.add_checkbox(
        "Sure marks only",
        initial_value=False,
        hint="Without doubtful caps and marks that hardly tell a centre",
    )
    pages = gui.add_button_group("Page", ("‹", "›"))
    page = [0]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.redraw_at_once(("review",))

    async def choose() -> None:
        page[0] = 0
        session.redraw_at_once(("review",))

    async def leave_out() -> None:
        page[0] = 0
        session.only_sure = only_sure.value
        session.redraw_at_once(("review", "plots", "cap_plot"))

    async def start() -> None:
        workspace.start_job(session, "Comparison with the predictions", compare_work(workspace.project))

    async def redraw() -> None:
        wanted = Wanted(
            order=order.value,
            by=GROUPS[by.value],
            only_sure=session.only_sure,
            run=session.run_on_photo,
            page=page[0],
        )
        review = await workspace.read(partial(find_review, wanted=wanted))
        page[0] = review.first // PAGE
        figures.content = review_figures(review).html
        shown.content = review_page(review, session.image.id if session.image else None, wanted).html
        pages.visible = review.total > PAGE
        compare.visible = review.stale > 0

    for control in (order, by):
        control.on_update(person_did(session, choose))
    only_sure.on_update(person_did(session, leave_out))
    pages.on_click(person_did(session, turn))
    compare.on_click(person_did(session, start))
    return redraw
