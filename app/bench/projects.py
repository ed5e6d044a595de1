"""Projects to measure: beds of evenly spaced caps on smooth, noisy ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import msgspec
import numpy as np
from msgspec import Struct

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project, create_project


class Bed(Struct, frozen=True, kw_only=True):
    """One photo and the caps on it."""

    name: str
    width: int
    height: int
    caps: int
    vertices: int
    """Vertices of each cap's outline."""
    seed: int = 0
    """Beds of one size and seed have the same photo."""


def make_project(folder: Path, beds: Sequence[Bed]) -> Project:
    """A project of these beds in ``folder``, their caps as annotations; open."""
    project = create_project(folder / "project")
    import_paths(project, [write_labels(folder / "photos", beds)], link=True)
    return project


def write_labels(folder: Path, beds: Sequence[Bed]) -> Path:
    """Photos, and a COCO file beside them, whose path is returned."""
    folder.mkdir(exist_ok=True)
    for bed in beds:
        (folder / bed.name).write_bytes(_photo(bed.width, bed.height, bed.seed))
    numbered = list(enumerate(beds, start=1))
    document = {
        "images": [
            {"id": number, "file_name": bed.name, "width": bed.width, "height": bed.height}
            for number, bed in numbered
        ],
        "categories": [{"id": 1, "name": DEFAULT_CATEGORY}],
        "annotations": [annotation for number, bed in numbered for annotation in _annotations(number, bed)],
    }
    labels = folder / "labels.json"
    labels.write_bytes(msgspec.json.encode(document))
    return labels


@lru_cache(maxsize=1)
def _photo(width: int, height: int, seed: int) -> bytes:
    random = np.random.default_rng(seed)
    coarse = random.integers(40, 215, (height // 16 + 2, width // 16 + 2, 3), np.uint8)
    ground = cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC)
    grain = random.integers(0, 24, (height, width, 1), np.uint8)
    return cv2.imencode(".jpg", cv2.add(ground, np.repeat(grain, 3, axis=2)))[1].tobytes()


def _annotations(image: int, bed: Bed) -> list[dict[str, Any]]:
    columns = math.ceil(math.sqrt(bed.caps * bed.width / bed.height))
    rows = math.ceil(bed.caps / columns)
    across, down = bed.width / columns, bed.height / rows
    angles = np.arange(bed.vertices) * (2 * math.pi / bed.vertices)
    radii = min(across, down) * (0.4 + 0.05 * np.sin(3 * angles + image))
    ring = np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)
    places = [((cap % columns + 0.5) * across, (cap // columns + 0.5) * down) for cap in range(bed.caps)]
    return [
        {
            "id": image * 1_000_000 + cap,
            "image_id": image,
            "category_id": 1,
            "segmentation": [(ring + place).round(2).ravel().tolist()],
            "iscrowd": 0,
        }
        for cap, place in enumerate(places)
    ]
