"""The panel of one browser tab: header and tools, the selected cap, then images, view, review and jobs."""

from __future__ import annotations

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels import (
    annotators,
    beside,
    desk,
    gallery,
    history,
    images,
    inspector,
    jobs,
    layers,
    learning,
    plots,
    predict,
    queue,
    review,
    runs,
    status,
    tools,
)
from fairyring.app.panels.callbacks import Redrawing

ALL = (
    *(
        "status",
        "images",
        "review",
        "gallery",
        "cap",
        "history",
        "queue",
        "desk",
        "beside",
        "annotators",
        "cap_plot",
        "plots",
    ),
    *("predict", "runs", "learning", "jobs"),
)
"""The parts that are drawn, in that order."""


def build_panel(workspace: Workspace, session: Session) -> None:
    """Fills the panel of a tab whose editor has said hello; a second time only draws it anew."""
    if not session.has_panel:
        gui = session.client.gui
        parts = {"status": status.build(workspace, session)}
        tools.build(session)
        parts["cap"] = inspector.build(workspace, session)
        pages = gui.add_tab_group()
        with pages.add_tab("Images"):
            parts["images"] = images.build(workspace, session)
        with pages.add_tab("View"):
            layers.build(session)
        with pages.add_tab("History"):
            parts["history"] = history.build(workspace, session)
        with pages.add_tab("Review"):
            parts["queue"] = queue.build(workspace, session)
            parts["desk"] = desk.build(workspace, session)
            parts["review"] = review.build(workspace, session)
            parts["gallery"] = gallery.build(workspace, session)
            parts["beside"] = beside.build(workspace, session)
            parts["annotators"] = annotators.build(workspace, session)
            parts |= plots.build(workspace, session)
        with pages.add_tab("Jobs"):
            parts["predict"] = predict.build(workspace, session)
            parts["runs"] = runs.build(workspace, session)
            parts["learning"] = learning.build(workspace, session)
            parts["jobs"] = jobs.build(workspace, session)
        redrawing = Redrawing({part: parts[part] for part in ALL})
        session.redraw, session.redraw_soon = redrawing.ask, redrawing.ask_later
        session.redraw_at_once = redrawing.ask_at_once
        session.has_panel = True
    session.refresh(*ALL)
