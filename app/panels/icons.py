"""Line icons of 24 × 24 for the toolbar, drawn in the text's colour."""

from __future__ import annotations

from fairyring.app.panels.markup import Markup

_PATHS = {
    "select": "M5 3l14 8-6 1.6L10 19z",
    "point": "M12 3v4M12 17v4M3 12h4M17 12h4M12 12v.01M12 8a4 4 0 100 8 4 4 0 000-8z",
    "polygon": "M12 4l8 6-3 9H7l-3-9zM12 4v.01M20 10v.01M17 19v.01M7 19v.01M4 10v.01",
    "circle": "M12 4a8 8 0 100 16 8 8 0 000-16zM12 11v2M11 12h2",
    "rim": "M5 17a9 9 0 1114 0M7 17c1 4 9 4 10 0",
    "rim_points": "M10.500 3h3v3h-3zM3 15h3v3H3zM18 15h3v3h-3zM6 7.500a8 8 0 00-1.500 5"
    "M18 7.500a8 8 0 011.500 5M8 19.500a8 8 0 008 0",
    "split": "M4 9a8 5 0 0116 0v6a8 5 0 01-16 0zM9 3l6 18",
    "arcs": "M12 4a8 8 0 018 8M20 14.500a8 8 0 01-3 4M14.500 19.600a8 8 0 01-5 0M7 18a8 8 0 01-1-11M8 5l2-.8",
    "merge": "M9 5a7 7 0 100 14M15 5a7 7 0 110 14M9 5h6M9 19h6",
    "tighten": "M12 5a7 7 0 100 14 7 7 0 000-14M2 12h3M19 12h3M12 2v3M12 19v3",
    "pan": "M12 3v18M3 12h18M12 3l-2.5 2.5M12 3l2.5 2.5M12 21l-2.5-2.5M12 21l2.5-2.5M3 12l2.5-2.5"
    "M3 12l2.5 2.5M21 12l-2.5-2.5M21 12l-2.5 2.5",
    "undo": "M9 6L4 11l5 5M4 11h10a6 6 0 010 12",
    "redo": "M15 6l5 5-5 5M20 11H10a6 6 0 000 12",
    "fit": "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
    "accept_all": "M2 13l4 4 8-9M10 16l1 1 9-10",
    "check": "M3 12l4 4 7-9M14 19h7M18 16l3 3-3 3",
    "accept": "M4 13l5 5L20 6",
    "take_models": "M4 13l5 5L20 6",
    "take_annotators": "M9 6L4 11l5 5M4 11h16",
    "delete": "M5 7h14M10 4h4M7 7l1 13h8l1-13M10 11v5M14 11v5",
    "done": "M4 5v14M8 12h11M14 7l5 5-5 5",
    "mark": "M12 4a8 8 0 100 16 8 8 0 000-16zM12 9v6M9 12h6",
    "unmark": "M12 4a8 8 0 100 16 8 8 0 000-16zM9 12h6",
    "doubtful": "M9 9a3 3 0 115 2c-1.2.8-2 1.4-2 3M12 18v.01",
    "ignored": "M12 4a8 8 0 100 16 8 8 0 000-16zM5 15L15 5M7 18L18 7M10 20l9-9",
    "help": "M3 6h18v12H3zM7 10v.01M11 10v.01M15 10v.01M18 10v.01M8 14h8",
    "previous_image": "M15 5l-7 7 7 7",
    "next_image": "M9 5l7 7-7 7",
}


def icon(name: str) -> Markup:
    """The icon of this name as SVG. Raises KeyError for one that is not drawn."""
    return Markup(
        '<svg class="fr-icon" viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="1.8" '
        f'stroke-linecap="round" stroke-linejoin="round" aria-hidden="true"><path d="{_PATHS[name]}"/></svg>'
    )
