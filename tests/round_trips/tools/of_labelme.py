"""Writes an export as labelme's files, has labelme read and write them: ``of_labelme.py EXPORT OUT``."""

import json
import sys
from pathlib import Path

from labelme._label_file import read_label_file, write_label_file

export, out = map(Path, sys.argv[1:])
document = json.loads((export / "instances.json").read_text())
names = {category["id"]: category["name"] for category in document["categories"]}


def shape(entry, nth, part):
    several = len(entry["segmentation"]) > 1
    return {
        "label": names[entry["category_id"]],
        "points": [list(point) for point in zip(part[0::2], part[1::2], strict=True)],
        "group_id": nth if several else None,
        "shape_type": "polygon",
        "flags": {},
        "description": "",
        "mask": None,
        "id": entry["id"],
        "uid": entry["uid"],
    }


for image in document["images"]:
    mine = [entry for entry in document["annotations"] if entry["image_id"] == image["id"]]
    file = out / Path(image["file_name"]).with_suffix(".json").name
    head = {
        "image_path": str(export.absolute() / "images" / image["file_name"]),
        "image_height": image["height"],
        "image_width": image["width"],
    }
    shapes = [shape(entry, nth, part) for nth, entry in enumerate(mine) for part in entry["segmentation"]]
    write_label_file(str(file), shapes=shapes, **head)
    read = read_label_file(str(file))
    again = [
        {k: v for k, v in each.items() if k != "other_data"} | each["other_data"] for each in read.shapes
    ]
    write_label_file(str(file), shapes=again, flags=read.flags, other_data=read.other_data, **head)
