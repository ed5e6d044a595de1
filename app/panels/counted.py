"""Numbers that lead to the caps they count, and the titles above them."""

from __future__ import annotations

from collections.abc import Mapping

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import Kind


def counted(kind: Kind, number: Content, *, group: Group | None = None) -> Markup:
    """A number that shows, once it is clicked, the caps that it counts or is the mean of.

    Args:
        kind: which caps these are.
        number: as it is shown.
        group: only those of a group; None for all images.
    """
    return element(
        "button", number, type="button", class_="fr-counted", data_fairyring_gallery=kind, **of_group(group)
    )


def of_group(group: Group | None) -> dict[str, str | float | bool | None]:
    """The attributes that say of which group the caps are that a button shows."""
    if group is None:
        return {}
    return {
        "data_fairyring_by": group.by,
        "data_fairyring_value": group.value,
        "data_fairyring_of_image": group.image,
        "data_fairyring_beside": group.beside,
    }


def titles_of(widths: Mapping[str, int | None]) -> Markup:
    """A line of titles with the widths of their columns, pixels; the one without a width takes the rest."""
    cells = (
        element("th", title, class_="fr-number" if width else None, width=width)
        for title, width in widths.items()
    )
    return element("thead", element("tr", *cells))
