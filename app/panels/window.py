"""The panel as wide and as dark as the window that it is in wants it."""

from __future__ import annotations

from fairyring.app.live.session import Session
from fairyring.app.protocol import Window

GREEN = (47, 111, 79)
WIDE, NARROW = 380, 304
"""Widths of the panel, CSS pixels."""
NARROW_BELOW = 1200
"""Windows less wide have a narrow panel; ``static/styles`` says the same."""


def panel_width(window: int) -> int:
    """How wide the panel is in a window of this width, both in CSS pixels."""
    return NARROW if window < NARROW_BELOW else WIDE


def follow_window(session: Session, window: Window) -> None:
    """Makes the panel of one tab light or dark, wide or narrow."""
    gui = session.client.gui
    gui.configure_theme(show_logo=False, show_share_button=False, brand_color=GREEN, dark_mode=window.dark)
    gui.main_panel.dock_right()
    gui.main_panel.set_width(panel_width(window.width))
