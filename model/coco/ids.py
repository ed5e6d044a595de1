"""Ids compare by value: 1, 1.0 and "1" are one id, as spreadsheets and data frames turn one into another."""

from __future__ import annotations

import re
from typing import Any

Id = int | str

WHOLE = re.compile(r"(0|-?[1-9][0-9]{0,18})(\.0)?")
"""Pattern of a whole number as text. 007 is none: beside it there may be a 7."""


def id_of(value: Any) -> Id | None:
    """An id in one form: a whole number, or a text that is none; None for everything else, booleans too."""
    if type(value) is int:
        return value
    if type(value) is float and value.is_integer():
        return int(value)
    if type(value) is str:
        number = WHOLE.fullmatch(value)
        return int(number[1]) if number else value
    return None
