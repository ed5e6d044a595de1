"""Batches: dataclasses of arrays whose first axis counts caps.

Caps are worked on many at a time and remembered one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, TypeVar

import numpy as np

Batch = TypeVar("Batch")


def single_caps(batch: Batch, *, caps: int) -> list[Batch]:
    """The batch of n = ``caps`` caps as n batches of one."""
    whole: Any = batch
    if not is_dataclass(type(batch)):
        return [whole[at : at + 1] for at in range(caps)]
    make: Any = type(batch)
    parts = [single_caps(getattr(batch, name), caps=caps) for name in _names_of(make)]
    return [make(*each) for each in zip(*parts, strict=True)]


def first_caps(batch: Batch, *, caps: int) -> Batch:
    """The first n = ``caps`` caps of a batch."""
    return _each(lambda array: array[:caps], [batch])


def joined(batches: Sequence[Batch]) -> Batch:
    """All of their caps as one batch; at least one batch must be given."""
    return _each(lambda *arrays: np.concatenate(arrays), batches)


def _each(work: Callable[..., np.ndarray], batches: Sequence[Any]) -> Any:
    """A batch each of whose arrays is made by ``work`` of the arrays in that place."""
    if not is_dataclass(type(batches[0])):
        return work(*batches)
    kind: Any = type(batches[0])
    return kind(*(_each(work, [getattr(batch, name) for batch in batches]) for name in _names_of(kind)))


@cache
def _names_of(kind: type[Any]) -> tuple[str, ...]:
    """The names of a dataclass's fields."""
    return tuple(field.name for field in fields(kind))
