"""How much the tests of faults do: a little with all other tests, more by ``make faults``."""

from __future__ import annotations

import os
from typing import Literal, TypeVar, cast

Form = Literal["short", "usual", "long"]
Value = TypeVar("Value")

FORM = cast(Form, os.environ.get("FAULTS", "short"))


def by_form(*, short: Value, usual: Value, long: Value) -> Value:
    """What the form asked for takes: seconds, minutes or an hour in all."""
    return {"short": short, "usual": usual, "long": long}[FORM]


def inputs(*, of: int) -> int:
    """How many of the inputs that the long form tries; it tries 100 000 of all kinds."""
    return int(by_form(short=0.002, usual=0.03, long=1.0) * of)
