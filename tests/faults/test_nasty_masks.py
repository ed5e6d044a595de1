"""Codes of masks that nobody means are read or refused, neither with a long wait."""

from __future__ import annotations

import contextlib
import random

import pytest

from fairyring.model.errors import FairyringError
from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.raster import check_rle
from tests.support.how_much import inputs
from tests.support.masks import code_of, disc, peppered
from tests.support.nasty import changed, changed_bytes
from tests.support.slowest import Slowest

DISC = disc(80, 60, 30, height=120, width=160)
RLE = inputs(of=30_000)


@pytest.mark.timeout(3600)
def test_codes_of_masks_are_read_or_refused() -> None:
    chance, slowest = random.Random(2), Slowest()
    seeds = [
        code_of(DISC),
        code_of(peppered(DISC, 0.05)),
        {"size": [120, 160], "counts": [80 * 120, 30, 79 * 120 + 90]},
    ]
    for _ in range(RLE):
        seed = chance.choice(seeds)
        code = changed(seed, chance, times=chance.randint(1, 2))
        if isinstance(code, dict) and isinstance(code.get("counts"), str) and chance.random() < 0.7:
            code["counts"] = changed_bytes(code["counts"].encode(errors="replace"), chance).decode("latin-1")
        with slowest.watched(code), contextlib.suppress(FairyringError):
            outline_of_rle(code)
        with slowest.watched(code), contextlib.suppress(FairyringError):
            check_rle(code)
    slowest.judge("RLE", RLE)
