"""COCO and labelme files that nobody means: no crash, no long wait, and what is good beside them goes in."""

from __future__ import annotations

import contextlib
import random
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fairyring.model.errors import FairyringError
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project, open_project
from tests.support.how_much import inputs
from tests.support.masks import code_of, disc
from tests.support.nasty import DEPTH, as_text, changed, text_of
from tests.support.slowest import Slowest

COCO, LABELME = inputs(of=30_000), inputs(of=20_000)
SQUARE = [20.0, 20.0, 60.0, 20.0, 60.0, 60.0, 20.0, 60.0]
DISC = disc(80, 60, 30, height=120, width=160)
GOOD = "good.png"
"""The photo of the item that nothing is wrong with."""
KEPT = {"project", "category", "image", "alembic_version"}
"""Tables that stay as they are from one import to the next."""


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
        item = {key: item[key] for key in ("id", "image_id", "category_id")} | {"segmentation": code_of(DISC)}
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
