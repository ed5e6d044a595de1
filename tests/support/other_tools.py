"""Files as other tools write them, out of an export of ours."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Points = list[list[float]]


def as_cvat(document: dict[str, Any]) -> dict[str, Any]:
    """CVAT's COCO: keys of its own alone, two decimals, and every annotation numbered anew."""
    return {
        "licenses": [{"name": "", "id": 0, "url": ""}],
        "info": {"contributor": "", "date_created": "", "description": "", "version": "", "year": ""},
        "categories": [
            {"id": category["id"], "name": category["name"], "supercategory": ""}
            for category in document["categories"]
        ],
        "images": [
            {key: image[key] for key in ("id", "file_name", "width", "height")}
            | {"license": 0, "flickr_url": "", "coco_url": "", "date_captured": 0}
            for image in document["images"]
        ],
        "annotations": [
            {
                "id": number,
                "image_id": entry["image_id"],
                "category_id": entry["category_id"],
                "segmentation": [[round(x, 2) for x in part] for part in entry["segmentation"]],
                "area": entry["area"],
                "bbox": [round(x, 2) for x in entry["bbox"]],
                "iscrowd": 0,
                "attributes": {"occluded": False},
            }
            for number, entry in enumerate(reversed(document["annotations"]), start=1)
        ],
    }


def write_labelme(
    document: dict[str, Any], folder: Path, *, moved: Callable[[int, Points], Points] = lambda _nth, p: p
) -> list[Path]:
    """labelme's files, one an image; ``moved`` changes the points of single shapes."""
    names = {category["id"]: category["name"] for category in document["categories"]}
    files = []
    for image in document["images"]:
        mine = [entry for entry in document["annotations"] if entry["image_id"] == image["id"]]
        shapes = []
        for nth, entry in enumerate(mine):
            for part in entry["segmentation"]:
                points = [list(pair) for pair in zip(part[0::2], part[1::2], strict=True)]
                shapes.append(
                    {
                        "label": names[entry["category_id"]],
                        "points": moved(nth, points),
                        "group_id": nth if len(entry["segmentation"]) > 1 else None,
                        "description": "",
                        "shape_type": "polygon",
                        "flags": {},
                        "mask": None,
                    }
                )
        file = folder / Path(image["file_name"]).with_suffix(".json").name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(
            json.dumps(
                {
                    "version": "5.5.0",
                    "flags": {},
                    "shapes": shapes,
                    "imagePath": image["file_name"],
                    "imageData": None,
                    "imageHeight": image["height"],
                    "imageWidth": image["width"],
                }
            )
        )
        files.append(file)
    return files
