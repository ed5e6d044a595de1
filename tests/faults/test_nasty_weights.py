"""Files of weights that nobody means are read or refused, neither with a long wait."""

from __future__ import annotations

import contextlib
import json
import random
from pathlib import Path

import pytest
import torch
from safetensors.torch import load, save

from fairyring.model.errors import FairyringError
from fairyring.model.network.weights import digest_of, load_weights, save_weights
from tests.support.how_much import inputs
from tests.support.nasty import as_text, changed, changed_bytes
from tests.support.slowest import MOST_S, Slowest
from tests.support.small_networks import TINY, tiny

WEIGHTS = inputs(of=5_000)


@pytest.mark.timeout(3600)
def test_weights_are_read_or_refused(tmp_path: Path) -> None:
    chance, slowest = random.Random(4), Slowest()
    good = tmp_path / "good.safetensors"
    save_weights(good, tiny().state_dict(), TINY, card={"AP": 0.5})
    data = good.read_bytes()
    length = int.from_bytes(data[:8], "little")
    head, state = json.loads(data[8 : 8 + length])["__metadata__"], load(data)
    # To build the network it names takes most of it.
    with slowest.watched(good):
        load_weights(good)
    usual_s = slowest.taken
    for _ in range(WEIGHTS):
        file = tmp_path / "odd.safetensors"
        if chance.random() < 0.5:
            file.write_bytes(changed_bytes(data[: 8 + length], chance) + data[8 + length :])
        else:
            told = as_text(changed(json.loads(head["network"]), chance, times=chance.randint(1, 2)), chance)
            network = told.decode("utf-8", errors="replace")
            odd = {key: value for key, value in state.items() if chance.random() > 0.002}
            if chance.random() < 0.3:
                key = chance.choice(list(odd))
                odd[key] = chance.choice([torch.zeros(0), torch.full((3,), torch.nan), odd[key][..., None]])
            metadata = head | {"network": network, "digest": digest_of(odd, network)}
            file.write_bytes(save(odd, metadata=metadata))
        with slowest.watched(file), contextlib.suppress(FairyringError):
            load_weights(file)
    slowest.judge("weights", WEIGHTS, most_s=MOST_S + 2 * usual_s)
