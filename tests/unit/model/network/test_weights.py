"""Weights in files: the same network comes back, and nothing else is believed."""

from __future__ import annotations

import contextlib
import pickle
import re
from pathlib import Path

import msgspec
import numpy as np
import pytest
import torch
from safetensors import safe_open
from safetensors.torch import save_file

from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import FORMAT, WeightsError, digest_of, load_weights, save_weights
from tests.support.small_networks import TINY, tiny

CARD = {"recipe": {"iterations": 3}, "AP": 0.5, "licence": "Apache-2.0"}


@pytest.fixture(scope="module")
def network() -> PRSOLOv2:
    return tiny()


@pytest.fixture(scope="module")
def saved(network: PRSOLOv2, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("weights") / "tiny.safetensors"
    save_weights(path, network.state_dict(), TINY, card=CARD)
    return path


def metadata_of(path: Path) -> dict[str, str]:
    with safe_open(path, framework="pt") as file:
        return dict(file.metadata())


def rewritten(path: Path, to: Path, **changes: str | None) -> Path:
    """The same tensors under other metadata."""
    with safe_open(path, framework="pt") as file:
        state = {key: file.get_tensor(key) for key in list(file.keys())}
    metadata = {key: value for key, value in (metadata_of(path) | changes).items() if value is not None}
    save_file(state, to, metadata=metadata)
    return to


def test_weights_come_back_in_half_precision_with_their_card(network: PRSOLOv2, saved: Path) -> None:
    weights = load_weights(saved)
    assert weights.network.config == TINY
    assert weights.card == CARD
    assert not weights.network.training
    state = network.state_dict()
    loaded = weights.network.state_dict()
    assert loaded.keys() == state.keys()
    for key, value in state.items():
        expected = value.half().float() if value.is_floating_point() else value
        assert loaded[key].dtype == value.dtype
        assert torch.equal(loaded[key], expected), key


def test_a_network_saved_again_has_the_same_digest(saved: Path, tmp_path: Path) -> None:
    weights = load_weights(saved)
    again = save_weights(tmp_path / "again.safetensors", weights.network.state_dict(), TINY, card={})
    assert again == weights.digest


def test_channels_last_weights_are_stored_as_others(saved: Path, tmp_path: Path) -> None:
    turned = tiny().to(memory_format=torch.channels_last)  # pyright: ignore
    digest = save_weights(tmp_path / "turned.safetensors", turned.state_dict(), TINY, card=CARD)
    assert digest == metadata_of(saved)["digest"]
    assert (tmp_path / "turned.safetensors").stat().st_size == saved.stat().st_size


def test_the_digest_is_of_the_network_and_of_names_shapes_and_values() -> None:
    state = {"b": torch.ones(2, 3), "a": torch.arange(4)}
    digest = digest_of(state, "n")
    assert digest == digest_of(dict(reversed(state.items())), "n")
    assert digest == digest_of(state | {"b": torch.ones(3, 2).T}, "n")
    assert digest != digest_of(state | {"b": torch.ones(3, 2)}, "n")
    assert digest != digest_of(state | {"a": torch.tensor([0, 1, 2, 4])}, "n")
    assert digest != digest_of({"b": state["b"], "c": state["a"]}, "n")
    assert digest != digest_of(state | {"b": torch.ones(2, 3, dtype=torch.float64)}, "n")
    assert digest != digest_of(state, "m")


def test_a_changed_byte_among_the_values_is_noticed(saved: Path, tmp_path: Path) -> None:
    content = bytearray(saved.read_bytes())
    header = int.from_bytes(content[:8], "little")
    rng = np.random.default_rng(0)
    for place in rng.integers(8 + header, len(content), 4):
        changed = bytearray(content)
        changed[place] ^= 1 << int(rng.integers(8))
        path = tmp_path / "changed.safetensors"
        path.write_bytes(changed)
        with pytest.raises(WeightsError, match="changed or damaged"):
            load_weights(path)


def test_a_changed_byte_in_the_header_loads_the_same_or_nothing(saved: Path, tmp_path: Path) -> None:
    """Whatever is wrong with a file, the answer is one sentence."""
    content = saved.read_bytes()
    header = int.from_bytes(content[:8], "little")
    digest = metadata_of(saved)["digest"]
    rng = np.random.default_rng(1)
    path = tmp_path / "changed.safetensors"
    for place in [*range(8), *rng.integers(8, 8 + header, 25)]:
        changed = bytearray(content)
        changed[place] = int(rng.integers(256))
        path.write_bytes(changed)
        with contextlib.suppress(WeightsError):
            assert load_weights(path).digest == digest


@pytest.mark.parametrize("share", [0.0, 0.00001, 0.001, 0.5, 0.999])
def test_a_file_that_was_cut_off_is_refused(saved: Path, tmp_path: Path, share: float) -> None:
    content = saved.read_bytes()
    path = tmp_path / "cut.safetensors"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(WeightsError, match="not a whole safetensors file"):
        load_weights(path)


def test_other_safetensors_are_refused(tmp_path: Path) -> None:
    for metadata in (None, {"format": "pt"}):
        path = tmp_path / "other.safetensors"
        save_file({"x": torch.ones(3, dtype=torch.bfloat16)}, path, metadata=metadata)
        with pytest.raises(WeightsError, match="no network of Fairyring's"):
            load_weights(path)


def test_a_pickle_is_refused_and_not_run(tmp_path: Path) -> None:
    marker = tmp_path / "was-run"

    class Harmful:
        def __reduce__(self) -> tuple[object, tuple[Path]]:
            return Path.mkdir, (marker,)

    path = tmp_path / "harmful.safetensors"
    path.write_bytes(pickle.dumps(Harmful()))
    with pytest.raises(WeightsError):
        load_weights(path)
    torch.save({"x": Harmful()}, path)
    with pytest.raises(WeightsError):
        load_weights(path)
    assert not marker.exists()


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(WeightsError, match=r"no weights at .*nowhere\.safetensors"):
        load_weights(tmp_path / "nowhere.safetensors")
    with pytest.raises(WeightsError, match=str(tmp_path)):
        load_weights(tmp_path)


@pytest.mark.parametrize(
    "told",
    [
        "{}",
        '{"backbone": "r18"}',
        '{"backbone": "vgg"}',
        '{"surprise": 1}',
        '{"head_channels": 33}',
        "not JSON",
        None,
    ],
)
def test_weights_of_another_network_than_the_file_says_are_refused(
    saved: Path, tmp_path: Path, told: str | None
) -> None:
    with safe_open(saved, framework="pt") as file:
        state = {key: file.get_tensor(key) for key in list(file.keys())}
    digest = digest_of(state, told or "")
    path = rewritten(saved, tmp_path / "other.safetensors", network=told, digest=digest)
    with pytest.raises(WeightsError, match="another network than it says"):
        load_weights(path)


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"fpn_channels": 0}, "fpn_channels of 0"),
        ({"head_channels": 10**9}, "head_channels of 1000000000"),
        ({"head_convs": -1}, "head_convs of -1"),
        ({"reduction": 10**12}, "reduction of"),
        ({"detail_channels": -4}, "detail_channels of -4"),
        ({"grids": [80, 64, 32, 16, 10**6]}, "grids of"),
        ({"grids": [80, 64, 0, 16, 12]}, "grids of"),
        ({"scale_ranges": [[1, 2]]}, "scale ranges of"),
        ({"scale_ranges": [[5, 2]] * 5}, "scale ranges of"),
    ],
)
def test_a_network_that_makes_no_sense_is_not_built(
    saved: Path, tmp_path: Path, changes: dict[str, object], what: str
) -> None:
    told = msgspec.json.encode(msgspec.to_builtins(TINY) | changes).decode()
    path = described_as(told, saved, tmp_path)
    with pytest.raises(WeightsError, match=f"described.safetensors .* makes no sense: {what}"):
        load_weights(path)


def test_a_large_network_with_small_tensors_is_not_built(saved: Path, tmp_path: Path) -> None:
    large = {"head_channels": 2048, "head_convs": 16, "fpn_channels": 2048}
    told = msgspec.json.encode(msgspec.to_builtins(TINY) | large).decode()
    with pytest.raises(WeightsError, match="another network than it says"):
        load_weights(described_as(told, saved, tmp_path))


def described_as(told: str, saved: Path, folder: Path) -> Path:
    """The tensors of a file, described otherwise, under a digest that is right."""
    with safe_open(saved, framework="pt") as file:
        state = {key: file.get_tensor(key) for key in list(file.keys())}
    digest = digest_of(state, told)
    return rewritten(saved, folder / "described.safetensors", network=told, digest=digest)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_values_that_are_no_numbers_are_not_loaded(saved: Path, tmp_path: Path, value: float) -> None:
    with safe_open(saved, framework="pt") as file:
        state = {key: file.get_tensor(key) for key in list(file.keys())}
    key = next(key for key, tensor in state.items() if tensor.is_floating_point() and tensor.numel() > 1)
    state[key].view(-1)[1] = value
    metadata = metadata_of(saved)
    metadata["digest"] = digest_of(state, metadata["network"])
    save_file(state, tmp_path / "odd.safetensors", metadata=metadata)
    with pytest.raises(WeightsError, match=f"{re.escape(key)} that are not finite"):
        load_weights(tmp_path / "odd.safetensors")


@pytest.mark.parametrize("kind", [torch.bfloat16, torch.float8_e4m3fn, torch.complex64, torch.bool])
def test_numbers_of_another_kind_are_refused(saved: Path, tmp_path: Path, kind: torch.dtype) -> None:
    save_file({"x": torch.zeros(4).to(kind)}, tmp_path / "odd.safetensors", metadata=metadata_of(saved))
    with pytest.raises(WeightsError, match="another kind"):
        load_weights(tmp_path / "odd.safetensors")


def test_a_card_of_endless_depth_is_refused(saved: Path, tmp_path: Path) -> None:
    deep = '{"a":' + "[" * 100_000 + "]" * 100_000 + "}"
    with pytest.raises(WeightsError):
        load_weights(rewritten(saved, tmp_path / "deep.safetensors", card=deep))


def test_weights_of_another_format_are_refused(saved: Path, tmp_path: Path) -> None:
    path = rewritten(saved, tmp_path / "later.safetensors", format=FORMAT[:-1] + "2")
    with pytest.raises(WeightsError, match="no network of Fairyring's"):
        load_weights(path)
    path = rewritten(saved, tmp_path / "bare.safetensors", digest=None)
    with pytest.raises(WeightsError, match="changed or damaged"):
        load_weights(path)


def test_values_that_are_no_numbers_are_not_saved(tmp_path: Path) -> None:
    path = tmp_path / "broken.safetensors"
    for value in (float("nan"), float("inf"), 1e6):
        with pytest.raises(WeightsError, match="first holds values that are not finite"):
            save_weights(path, {"first": torch.tensor([1.0, value])}, TINY, card={})
    assert not path.exists()


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(WeightsError, match=r"tiny\.safetensors cannot be written"):
        save_weights(tmp_path / "file" / "tiny.safetensors", {"x": torch.ones(1)}, TINY, card={})


def test_the_header_names_the_network(saved: Path) -> None:
    told = msgspec.json.decode(metadata_of(saved)["network"])
    assert told["fpn_channels"] == 32
    assert told["backbone"] == "lite0"


def test_a_network_described_otherwise_than_it_was_saved_is_noticed(saved: Path, tmp_path: Path) -> None:
    content = saved.read_bytes()
    assert b'reduction\\":1' in content
    changed = tmp_path / "changed.safetensors"
    changed.write_bytes(content.replace(b'reduction\\":1', b'reduction\\":2'))
    with pytest.raises(WeightsError, match="changed or damaged"):
        load_weights(changed)
