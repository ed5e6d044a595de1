"""Imports an export with datumaro and exports it as COCO: ``of_datumaro.py EXPORT OUT``.

Datumaro goes by the names of folders and files, so that the export is laid out anew first.
"""

import shutil
import sys
from pathlib import Path

import datumaro

export, out = map(Path, sys.argv[1:])
given = out / "given"
shutil.copytree(export / "images", given / "images" / "default")
(given / "annotations").mkdir()
shutil.copy(export / "instances.json", given / "annotations" / "instances_default.json")
loaded = datumaro.Dataset.import_from(str(given), "coco_instances")
loaded.export(str(out / "coco"), "coco_instances")
(written,) = (out / "coco" / "annotations").glob("*.json")
written.rename(out / "labels.json")
