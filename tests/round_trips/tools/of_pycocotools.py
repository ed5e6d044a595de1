"""Reads an export with pycocotools and writes what that holds: ``of_pycocotools.py EXPORT OUT``."""

import json
import sys
from pathlib import Path

from pycocotools.coco import COCO

export, out = map(Path, sys.argv[1:])
coco = COCO(str(export / "instances.json"))
written = {
    "images": coco.loadImgs(coco.getImgIds()),
    "categories": coco.loadCats(coco.getCatIds()),
    "annotations": coco.loadAnns(coco.getAnnIds()),
}
(out / "labels.json").write_text(json.dumps(written))
