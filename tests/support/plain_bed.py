"""A bed whose caps lie where a test wants them: on a plain photo of 640 × 400, at once."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project

SIZE = 640, 400


def ring(cx: float, cy: float, r: float, *, cut: float = math.inf, count: int = 40) -> list[float]:
    """A circle as a polygon, of which nothing is right of x = ``cut``."""
    angles = [2 * math.pi * k / count for k in range(count)]
    return [value for a in angles for value in (min(cx + r * math.cos(a), cut), cy + r * math.sin(a))]


def make_empty_bed(folder: Path) -> Path:
    """A project with one dark photo of 100 × 80 and no caps."""
    assert cv2.imwrite(str(folder / "bed.png"), np.zeros((80, 100, 3), np.uint8))
    with create_project(folder / "beds") as project:
        import_paths(project, [folder / "bed.png"])
    return folder / "beds"


def make_bed(
    folder: Path,
    caps: Sequence[Sequence[list[float]]],
    *,
    said: bool = False,
    scores: Sequence[float] = (),
    discs: Sequence[tuple[int, int, int]] = (),
) -> Path:
    """A project with one photo for each list of outlines: annotations, or what a network ``said``.

    ``scores`` are those of each photo's predictions, .9 where they are not given; ``discs`` are bright in
    every photo: centre and radius, pixels.
    """
    source, project = folder / "source", folder / "project"
    source.mkdir()
    images, annotations = [], []
    for number, outlines in enumerate(caps, start=1):
        name = f"bed_{number}.png"
        photo = np.full((SIZE[1], SIZE[0], 3), 20 * number, np.uint8)
        for x, y, r in discs:
            # The middle of pixel i is i + 0.5, for OpenCV i; it takes sixteenths.
            cv2.circle(photo, (16 * x - 8, 16 * y - 8), 16 * r, (200, 200, 200), -1, cv2.LINE_AA, 4)
        cv2.imwrite(str(source / name), photo)
        images.append({"id": number, "file_name": name, "width": SIZE[0], "height": SIZE[1]})
        annotations += [
            {"id": len(annotations) + k, "image_id": number, "category_id": 1, "segmentation": [outline]}
            | ({"score": scores[k - 1] if scores else 0.9} if said else {})
            for k, outline in enumerate(outlines, start=1)
        ]
    document = {"images": images, "annotations": annotations, "categories": [{"id": 1, "name": "mushroom"}]}
    (source / "instances.json").write_text(json.dumps(document))
    with create_project(project) as made:
        import_paths(made, [source], as_=ImportAs.predictions if said else ImportAs.annotations, strict=True)
    return project
