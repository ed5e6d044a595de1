"""A tab's panel: header and tools on top, the selected cap below them, then the tabs."""

from __future__ import annotations

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels import images, jobs, predict, review, status, tools
from fairyring.app.panels import inspector as cap
from fairyring.app.panels import layers as view
from fairyring.app.panels.callbacks import Redrawing


def build_panel(workspace: Workspace, session: Session) -> None:
    """Fills the panel of a tab whose editor has said hello; a second time only draws it anew."""
    if not session.has_panel:
        gui = session.client.gui
        parts = {"status": status.build(workspace, session)}
        tools.build(workspace, session)
        parts["cap"] = cap.build(workspace, session)
        tabs = gui.add_tab_group()
        with tabs.add_tab("Images"):
            parts["images"] = images.build(workspace, session)
        with tabs.add_tab("View"):
            parts["layers"] = view.build(workspace, session)
        with tabs.add_tab("Review"):
            parts["review"] = review.build(workspace, session)
        with tabs.add_tab("Jobs"):
            parts["predict"] = predict.build(workspace, session)
            parts["jobs"] = jobs.build(workspace, session)
        session.redraw = Redrawing(parts).ask
        session.has_panel = True
    session.refresh("status", "cap", "images", "layers", "review", "predict", "jobs")
