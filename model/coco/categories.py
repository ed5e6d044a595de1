"""The categories of a COCO document."""

from __future__ import annotations

from typing import Any

from fairyring.model.coco.document import Document
from fairyring.model.coco.ids import Id, id_of
from fairyring.model.json_values import ValueRefusedError, shown

DEFAULT_CATEGORY = "mushroom"
"""Category of a cap that nobody gave another one."""
MOST_LETTERS = 200


def listed_categories(document: Document) -> dict[Id, dict[str, Any]]:
    """The entries of the categories by id; of several with one id the first."""
    entries = document.others.get("categories")
    listed: dict[Id, dict[str, Any]] = {}
    for entry in entries if isinstance(entries, list) else ():
        own = id_of(entry.get("id")) if isinstance(entry, dict) else None
        if own is not None:
            listed.setdefault(own, entry)
    return listed


def name_of_category(entry: dict[str, Any]) -> str:
    """The name of a category. Raises ValueRefusedError where that is no short printable line."""
    name = entry.get("name")
    if not isinstance(name, str) or not name.isprintable() or not 0 < len(name) <= MOST_LETTERS:
        whose = f"The name of category {shown(entry.get('id'))}"
        longer = f", but of {len(name)}" if isinstance(name, str) and len(name) > MOST_LETTERS else ""
        raise ValueRefusedError(f"{whose} is not a line of 1 to {MOST_LETTERS} letters{longer}.")
    return name


def category_of(entry: dict[str, Any], listed: dict[Id, dict[str, Any]]) -> str:
    """The name of an annotation's category; the default one in a document that lists none.

    An annotation that names none is of the only category there is. Raises ValueRefusedError.
    """
    if not listed:
        return DEFAULT_CATEGORY
    given = entry.get("category_id")
    if given is None and len(listed) == 1:
        return name_of_category(next(iter(listed.values())))
    own = id_of(given)
    if own is None or own not in listed:
        raise ValueRefusedError(f"There is no category {shown(given)}.")
    return name_of_category(listed[own])
