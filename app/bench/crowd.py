"""A photo of caps that lie on each other, with their outlines as a run's predictions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import msgspec
import numpy as np

from fairyring.app.caps.filling_in import fill_in
from fairyring.model.geometry.mask_tracing import outline_of_mask
from fairyring.model.geometry.shapes import Outline
from fairyring.model.scene.clusters import ClusterCap, Recipe, make_cluster
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project

CROWD = 449
"""How many caps; as many as the most crowded of the checked photos holds."""
CROWD_PHOTO = "crowd.jpg"
ACROSS = 3
"""Clusters side by side, and one above the other."""
CLUSTER = Recipe(width=1280, height=720, count=50, noise=1.0)


def add_crowd(project: Project, folder: Path, *, caps: int = CROWD) -> None:
    """Adds the photo, linked from ``folder``, and its predictions, fitted."""
    add_crowds(project, folder, [CROWD_PHOTO], caps=caps)


def add_crowds(project: Project, folder: Path, names: Sequence[str], *, caps: int = CROWD) -> None:
    """Adds photos of so many caps each, no two alike, as `add_crowd` adds one."""
    folder.mkdir(exist_ok=True)
    width, height = ACROSS * CLUSTER.width, ACROSS * CLUSTER.height
    for name in names:
        cv2.imwrite(str(folder / name), np.full((height, width, 3), 90, np.uint8))
    outlines = [(image, each) for image in range(len(names)) for each in crowded_outlines(caps, crowd=image)]
    document = {
        "images": [
            {"id": image, "file_name": name, "width": width, "height": height}
            for image, name in enumerate(names)
        ],
        "categories": [{"id": 1, "name": "mushroom"}],
        "annotations": [
            {"id": number, "image_id": image, "category_id": 1, "segmentation": outline, "score": 0.9}
            for number, (image, outline) in enumerate(outlines, start=1)
        ],
    }
    labels = folder / "crowd.json"
    labels.write_bytes(msgspec.json.encode(document))
    import_paths(project, [labels], as_=ImportAs.predictions, link=True)
    fill_in(project)


def crowded_outlines(caps: int, *, crowd: int = 0) -> list[Outline]:
    """Visible outlines of so many caps, in clusters on a grid; every ``crowd`` has others."""
    outlines: list[Outline] = []
    for index in range(ACROSS**2):
        row, column = divmod(index, ACROSS)
        corner = column * CLUSTER.width, row * CLUSTER.height
        if len(outlines) < caps:
            cluster = make_cluster(seed=crowd * ACROSS**2 + index, recipe=CLUSTER)
            outlines += [_outline(cap, *corner) for cap in cluster.caps]
    return outlines[:caps]


def _outline(cap: ClusterCap, left: int, top: int) -> Outline:
    corner = np.array([left + cap.left, top + cap.top])
    return [(np.reshape(part, (-1, 2)) + corner).ravel().tolist() for part in outline_of_mask(cap.mask)]
