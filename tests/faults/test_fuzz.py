"""Files and messages that nobody means: no crash, no long wait, and what is good beside them goes in."""

from __future__ import annotations

import contextlib
import json
import logging
import random
import shutil
import sqlite3
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest
import torch
from pycocotools import mask as pycocotools_mask
from safetensors.torch import load, save

from fairyring.app.bench.serving import served
from fairyring.app.protocol import Fitted, Open, Outcomes, Refit, Show
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.raster import check_rle
from fairyring.model.network.weights import digest_of, load_weights, save_weights
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project, create_project, open_project
from fairyring.storage.records import Accepted, Cap
from tests.support.consistent import faults_of
from tests.support.how_much import by_form
from tests.support.nasty import DEPTH, as_text, changed, changed_bytes, text_of
from tests.support.small_networks import TINY, tiny
from tests.support.tab import Tab

log = logging.getLogger(__name__)

SHARE = by_form(short=0.002, usual=0.03, long=1.0)
COCO, LABELME, RLE, MESSAGES, WEIGHTS = (
    int(SHARE * count) for count in (30_000, 20_000, 30_000, 15_000, 5_000)
)
"""How many inputs of each kind; 100 000 in the long form."""
MOST_S = 1.0
"""Longest time an input may take, of the processor."""
LONGEST_WAIT_S = 3.0
"""Longest time until the next message is answered, by a clock on the wall."""
SQUARE = [20.0, 20.0, 60.0, 20.0, 60.0, 60.0, 20.0, 60.0]
KEPT = {"project", "category", "image", "alembic_version"}
"""Tables that stay as they are from one import to the next."""
GOOD = "good.png"
"""The photo of the item that nothing is wrong with."""


class Slowest:
    """The input that took longest, in seconds of the processor."""

    def __init__(self) -> None:
        self.taken, self.given = 0.0, ""

    @contextlib.contextmanager
    def watched(self, given: object) -> Iterator[None]:
        begun = time.process_time()
        yield
        taken = time.process_time() - begun
        if taken > self.taken:
            self.taken, self.given = taken, repr(given)[:2000]

    def judge(self, what: str, count: int, *, most_s: float = MOST_S) -> None:
        log.info("%s: %d inputs, the slowest %.2f s", what, count, self.taken)
        assert self.taken < most_s, self.given


def rle_of(mask: np.ndarray) -> dict[str, Any]:
    code = pycocotools_mask.encode(np.asfortranarray(mask.astype(np.uint8)))
    return {"size": [int(side) for side in code["size"]], "counts": code["counts"].decode()}


def disc() -> np.ndarray:
    y, x = np.mgrid[:120, :160]
    return (x - 80) ** 2 + (y - 60) ** 2 < 30**2


def coco_item() -> dict[str, Any]:
    return {
        **{"id": 1, "image_id": 1, "category_id": 1, "segmentation": [list(SQUARE)], "iscrowd": 0},
        **{"bbox": [20, 20, 40, 40], "area": 1600, "score": 0.5, "uid": "cap", "order": 2, "doubtful": True},
        **{"center": [40, 40], "circle": [40, 40, 20], "ellipse": [40, 40, 20, 15, 30], "mark": list(SQUARE)},
        **{"ignored": False, "extra": {"a": [1, "b"]}, "marked": True, "keypoints": [40, 40, 2]},
    }


def coco_image(number: int, name: str) -> dict[str, Any]:
    told = {"light": "top", "form": "a", "split": "train", "license": 1}
    return {"id": number, "file_name": name, "width": 160, "height": 120, **told}


def nasty_coco(chance: random.Random) -> tuple[bytes, bool]:
    """A file, and whether its good item must go in: only other items of it were changed."""
    item = coco_item()
    if chance.random() < 0.3:
        item = {key: item[key] for key in ("id", "image_id", "category_id")} | {
            "segmentation": rle_of(disc())
        }
    good = {"id": 2, "image_id": 2, "category_id": 1, "segmentation": [list(SQUARE)]}
    document = {
        "images": [coco_image(1, "bed.png"), coco_image(2, GOOD)],
        "categories": [{"id": 1, "name": "mushroom", "supercategory": "fungi"}],
        "licenses": [{"id": 1, "name": "free"}],
        "annotations": [item, good],
    }
    what = chance.random()
    if what < 0.6:
        document["annotations"][0] = changed(item, chance, times=chance.randint(1, 3))
    elif what < 0.8:
        document["images"][0] = changed(document["images"][0], chance, times=chance.randint(1, 2))
    else:
        return as_text(changed(document, chance, times=chance.randint(1, 4)), chance), False
    return text_of(document), True


def nasty_labelme(chance: random.Random) -> tuple[bytes, bool]:
    shape = {"label": "cap", "points": [[20, 20], [60, 20], [60, 60]], "group_id": None, "flags": {}}
    circle = {"label": "cap", "points": [[80, 60], [100, 60]], "group_id": 1, "shape_type": "circle"}
    good = {"label": "mushroom", "points": [[90, 20], [120, 20], [120, 60]], "shape_type": "polygon"}
    document = {
        **{"version": "5.0", "imagePath": GOOD, "imageData": None, "imageHeight": 120, "imageWidth": 160},
        "shapes": [shape | {"shape_type": "polygon"}, circle, good],
    }
    if chance.random() < 0.7:
        at = chance.randrange(2)
        document["shapes"][at] = changed(document["shapes"][at], chance, times=chance.randint(1, 3))
        return text_of(document), True
    return as_text(changed(document, chance, times=chance.randint(1, 4)), chance), False


@pytest.fixture(scope="module")
def beds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project of two photos, to be copied."""
    folder = tmp_path_factory.mktemp("fuzz")
    for number, name in enumerate(("bed.png", GOOD)):
        PIL.Image.fromarray(np.full((120, 160, 3), 90 + number, np.uint8)).save(folder / name)
    with create_project(folder / "beds") as project:
        import_paths(project, [folder / "bed.png", folder / GOOD])
    return folder / "beds"


@pytest.mark.timeout(3600)
@pytest.mark.parametrize(
    ("make", "count"), [(nasty_coco, COCO), (nasty_labelme, LABELME)], ids=["COCO", "labelme"]
)
def test_one_bad_item_of_a_file_never_ends_an_import(
    beds: Path, tmp_path: Path, make: Callable[[random.Random], tuple[bytes, bool]], count: int
) -> None:
    chance, slowest = random.Random(1), Slowest()
    folder = Path(shutil.copytree(beds, tmp_path / "beds"))
    file = tmp_path / "labels.json"
    with open_project(folder) as project:
        for _ in range(count):
            data, has_good = make(chance)
            # A file that no program would write is refused as a whole.
            has_good = has_good and b"[" * DEPTH not in data
            file.write_bytes(data)
            as_ = ImportAs.predictions if chance.random() < 0.1 else ImportAs.annotations
            with slowest.watched(data):
                went_in = _imported(project, file, as_=as_)
            assert went_in or not has_good, data
            assert _caps_of(folder, GOOD) > 0 or not has_good, data
            assert went_in or _caps_of(folder) == 0, data
            _empty(folder)
    slowest.judge(make.__name__, count)


def _imported(project: Project, file: Path, *, as_: ImportAs) -> bool:
    """Whether anything of the file could be used."""
    try:
        import_paths(project, [file], as_=as_)
    except FairyringError:
        return False
    return True


def _caps_of(folder: Path, name: str = "%") -> int:
    """How many annotations and predictions there are of the photos of this name."""
    counts = "".join(
        f"SELECT count(*) FROM {table} JOIN image ON image.id = {table}.image WHERE file_name LIKE ?1 {union}"
        for table, union in (("annotation", "UNION ALL "), ("prediction", ""))
    )
    with contextlib.closing(sqlite3.connect(folder / "project.db")) as connection:
        return sum(count for (count,) in connection.execute(counts, (name,)))


def _empty(folder: Path) -> None:
    """Takes everything out again but the photos, also what nobody may: the journal."""
    with contextlib.closing(sqlite3.connect(folder / "project.db")) as connection, connection:
        named = connection.execute("SELECT type, name FROM sqlite_master WHERE name NOT LIKE 'sqlite_%'")
        for kind, name in named.fetchall():
            if kind == "trigger":
                connection.execute(f"DROP TRIGGER {name}")
        for kind, name in connection.execute("SELECT type, name FROM sqlite_master").fetchall():
            if kind == "table" and name not in KEPT and not name.startswith("sqlite_"):
                connection.execute(f"DELETE FROM {name}")
        connection.execute("UPDATE image SET run = NULL, caps = 0, ignored = 0, predicted = 0")


@pytest.mark.timeout(3600)
def test_codes_of_masks_are_read_or_refused() -> None:
    chance, slowest = random.Random(2), Slowest()
    noisy = disc() & (np.random.default_rng(1).random((120, 160)) > 0.05)
    seeds = [rle_of(disc()), rle_of(noisy), {"size": [120, 160], "counts": [80 * 120, 30, 79 * 120 + 90]}]
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


def messages() -> list[dict[str, Any]]:
    """One of each that an editor sends."""
    cap = {"visible": [list(SQUARE)], "mark": {"kind": "circle", "cx": 40, "cy": 40, "r": 20}}
    polygon = {"visible": [], "mark": {"kind": "polygon", "points": list(SQUARE)}}
    edit = {"id": "e", "annotation": "a", "image": 1, "base": 0, "cap": cap}
    return [
        {"type": "edits", "edits": [edit, edit | {"id": "f", "annotation": "b", "cap": polygon}]},
        {"type": "refit", "seq": 1, "image": 1, "annotation": "a", "cap": cap},
        {"type": "open", "image": 1, "select": "a"},
        {"type": "step", "by": 1},
        {"type": "select", "annotation": "a", "prediction": 1},
        {"type": "status", "image": 1, "status": "annotated"},
        {"type": "saving", "waiting": 3},
        {"type": "toggle", "layer": "photo"},
    ]


def longest_wait(tab: Tab, numbers: range, chance: random.Random, acknowledged: dict[str, str]) -> float:
    """Seconds until the server had answered the next message, after one of so many that nobody means.

    Notes the annotations of the edits it acknowledged.
    """
    seeds, longest = messages(), 0.0
    tab.expect(Show)
    # The process that fits starts with the first question.
    tab.send(Refit(seq=0, image=1, annotation="x", cap=Cap(visible=[SQUARE])))
    tab.expect(Fitted, within_s=60)
    for number in numbers:
        seed = changed(chance.choice(seeds), chance, times=chance.randint(1, 3))
        edits = seed.get("edits") if isinstance(seed, dict) and chance.random() < 0.5 else None
        for edit in edits if isinstance(edits, list) else []:
            if isinstance(edit, dict):
                edit |= {"id": f"edit {number}", "annotation": f"cap {number}"}
        tab.editor.send(as_text(seed, chance).decode("utf-8", errors="replace"))
        sent = time.monotonic()
        # It may have opened another image.
        tab.send(Open(image=1))
        tab.send(Refit(seq=10**6 + number, image=1, annotation="x", cap=Cap(visible=[SQUARE])))
        tab.expect(Fitted, lambda found, number=number: found.seq == 10**6 + number, within_s=60)
        longest = max(longest, time.monotonic() - sent)
        for message in tab.received:
            if isinstance(message, Outcomes):
                accepted = [each for each in message.outcomes if isinstance(each, Accepted)]
                acknowledged |= {each.edit: each.annotation.uid for each in accepted}
        tab.received.clear()
    return longest


@pytest.mark.timeout(3600)
def test_whatever_an_editor_sends_the_server_answers_the_next_within_a_second(
    beds: Path, tmp_path: Path
) -> None:
    chance = random.Random(3)
    folder = Path(shutil.copytree(beds, tmp_path / "beds"))
    acknowledged: dict[str, str] = {}
    longest = 0.0
    with served(folder) as server:
        for first in range(0, MESSAGES, 500):
            numbers = range(first, min(first + 500, MESSAGES))
            with Tab(server.port, image=1) as tab:
                longest = max(longest, longest_wait(tab, numbers, chance, acknowledged))
    log.info("messages: %d inputs, the longest wait %.2f s", MESSAGES, longest)
    assert faults_of(folder / "project.db", acknowledged=acknowledged) == []
    assert longest < LONGEST_WAIT_S


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
