"""What commands around the network share: the device to compute on, and the passes over a photo."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fairyring.model.predict.passes import Pass


class Device(StrEnum):
    """The device to compute on."""

    auto = "auto"
    cpu = "cpu"
    cuda = "cuda"


Fast = Annotated[
    bool, typer.Option(help="One pass over each photo, not two: quicker, and more small caps are missed.")
]
OnDevice = Annotated[Device, typer.Option(help="auto takes a GPU where there is one.")]


def passes_of(*, fast: bool) -> tuple[Pass, ...]:
    """One pass over each photo, or two."""
    from fairyring.model.predict.passes import ONE_PASS, TWO_PASSES

    return ONE_PASS if fast else TWO_PASSES
