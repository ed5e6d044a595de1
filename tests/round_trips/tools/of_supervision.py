"""Loads an export with supervision and saves it as COCO: ``of_supervision.py EXPORT OUT``."""

import sys
from pathlib import Path

import supervision

export, out = map(Path, sys.argv[1:])
loaded = supervision.DetectionDataset.from_coco(
    images_directory_path=str(export / "images"),
    annotations_path=str(export / "instances.json"),
    force_masks=True,
)
loaded.as_coco(annotations_path=str(out / "labels.json"))
