"""A photo of caps that lie on each other, with their outlines as a run's predictions."""

from __future__ import annotations

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
    folder.mkdir(exist_ok=True)
    width, height = ACROSS * CLUSTER.width, ACROSS * CLUSTER.height
    cv2.imwrite(str(folder / CROWD_PHOTO), np.full((height, width, 3), 90, np.uint8))
    document = {
        "images": [{"id": 1, "file_name": CROWD_PHOTO, "width": width, "height": height}],
        "categories": [{"id": 1, "name": "mushroom"}],
        "annotations": [
            {"id": number, "image_id": 1, "category_id": 1, "segmentation": outline, "score": 0.9}
            for number, outline in enumerate(crowded_outlines(caps), start=1)
        ],
    }
    labels = folder / "crowd.json"
    labels.write_bytes(msgspec.json.encode(document))
    import_paths(project, [labels], as_=ImportAs.predictions, link=True)
    fill_in(project)


def crowded_outlines(caps: int) -> list[Outline]:
    """Visible outlines of so many caps, in clusters on a grid."""
    outlines: list[Outline] = []
    for index in range(ACROSS**2):
        row, column = divmod(index, ACROSS)
        corner = column * CLUSTER.width, row * CLUSTER.height
        if len(outlines) < caps:
            outlines += [_outline(cap, *corner) for cap in make_cluster(seed=index, recipe=CLUSTER).caps]
    return outlines[:caps]


def _outline(cap: ClusterCap, left: int, top: int) -> Outline:
    corner = np.array([left + cap.left, top + cap.top])
    return [(np.reshape(part, (-1, 2)) + corner).ravel().tolist() for part in outline_of_mask(cap.mask)]
