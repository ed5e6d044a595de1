"""COCO files as other tools write them, in their layouts."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from pycocotools.mask import encode

from tests.strangers.bed import HEIGHT, WIDTH, Stranger, box, circle, flat, mask, photo, write

Entry = dict[str, Any]


def image(number: Any = 1, name: str = "bed_1.jpg", **keys: Any) -> Entry:
    return {"id": number, "file_name": name, "width": WIDTH, "height": HEIGHT} | keys


def caps(number: Any = 1, *, first: int = 1, **keys: Any) -> list[Entry]:
    """Both caps of an image, as polygons unless ``keys`` say otherwise."""
    return [
        {"id": first + nth, "image_id": number, "category_id": 1, "iscrowd": 0}
        | {"segmentation": [flat(circle(nth))], "bbox": box(nth), "area": 2000.0}
        | {key: value(nth) if callable(value) else value for key, value in keys.items()}
        for nth in range(2)
    ]


def document(images: list[Entry], annotations: list[Entry], **keys: Any) -> Entry:
    categories = [{"id": 1, "name": "mushroom", "supercategory": ""}]
    return {"images": images, "annotations": annotations, "categories": categories} | keys


def single(place: str = "labels.json", photo_at: str = "bed_1.jpg", *, name: str = "bed_1.jpg", **keys: Any):
    """A file with one image; the photo lies at ``photo_at``, and the file itself is imported."""

    def make(folder: Path) -> Sequence[Path]:
        photo(folder / photo_at)
        return [write(folder / place, document([image(name=name)], caps(**keys)))]

    return make


def roboflow(folder: Path) -> Sequence[Path]:
    for number, split in enumerate(("train", "valid")):
        photo(folder / split / "bed_1_jpg.rf.0f1e2d3c4b5a69788796a5b4c3d2e1f0.jpg", moved=20 * number)
        named = image(0, "bed_1_jpg.rf.0f1e2d3c4b5a69788796a5b4c3d2e1f0.jpg", extra={"name": "bed_1.jpg"})
        categories = [{"id": 0, "name": "mushrooms", "supercategory": "none"}]
        categories += [{"id": 1, "name": "mushroom", "supercategory": "mushrooms"}]
        labels = document([named], caps(0), categories=categories, info={"year": "2024"})
        write(folder / split / "_annotations.coco.json", labels)
    return [folder]


def two_folders(folder: Path) -> Sequence[Path]:
    images = []
    for number, part in enumerate(("monday", "tuesday"), start=1):
        photo(folder / "images" / part / "bed_1.jpg", moved=20 * number)
        images.append(image(number, f"{part}/bed_1.jpg"))
    return [write(folder / "instances.json", document(images, [*caps(1), *caps(2, first=3)]))]


def two_folders_flat(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    images = [
        image(number, f"{part}/bed_1.jpg") for number, part in enumerate(("monday", "tuesday"), start=1)
    ]
    return [write(folder / "instances.json", document(images, [*caps(1), *caps(2, first=3)]))]


def mmdetection(folder: Path) -> Sequence[Path]:
    photo(folder / "data" / "train2017" / "bed_1.jpg")
    return [write(folder / "data" / "annotations" / "instances_train2017.json", document([image()], caps()))]


def cvat(folder: Path) -> Sequence[Path]:
    photo(folder / "images" / "default" / "bed_1.jpg")
    labels = document([image(license=0, flickr_url="", coco_url="", date_captured=0)], caps())
    labels |= {"licenses": [{"name": "", "id": 0, "url": ""}], "info": {"contributor": "", "year": ""}}
    for entry in labels["annotations"]:
        entry["attributes"] = {"occluded": False}
    return [write(folder / "annotations" / "instances_default.json", labels)]


def label_studio(folder: Path) -> Sequence[Path]:
    photo(folder / "images" / "bed_1.jpg")
    named = image(0, "images\\9f1c2d3e-bed_1.jpg")
    categories = [{"id": 0, "name": "mushroom"}]
    entries = caps(0, first=0, category_id=0, ignore=0)
    return [write(folder / "result.json", document([named], entries, categories=categories))]


def zipped(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    file = folder / "labels.json.gz"
    file.write_bytes(gzip.compress(json.dumps(document([image()], caps())).encode()))
    return [file]


def results(photos: Callable[[Path], Sequence[Path]], **keys: Any):
    """A list of results, and the files that say which photos it is about."""

    def make(folder: Path) -> Sequence[Path]:
        entries = caps(**keys, score=lambda nth: 0.9 - nth / 10)
        return [*photos(folder), write(folder / "results.json", entries)]

    return make


def listed(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    return [write(folder / "truth.json", document([image(7)], []))]


def compressed(nth: int) -> Entry:
    rle = encode(mask(nth).astype("uint8", order="F"))
    return {"size": rle["size"], "counts": rle["counts"].decode()}


def counted(nth: int) -> Entry:
    flat_mask = mask(nth).T.reshape(-1)
    counts, value, run = [], 0, 0
    for pixel in flat_mask.tolist():
        if pixel != value:
            counts.append(run)
            value, run = pixel, 0
        run += 1
    return {"size": [HEIGHT, WIDTH], "counts": [*counts, run]}


def without_categories(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    labels = document([image()], caps())
    del labels["categories"]
    return [write(folder / "labels.json", labels)]


def of_text_ids(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    entries = caps("1.0", iscrowd="0", category_id="1")
    labels = document([image(1.0)], entries, categories=[{"id": 1.0, "name": "mushroom"}])
    return [write(folder / "labels.json", labels)]


def without_photo(folder: Path) -> Sequence[Path]:
    return [photo(folder / "other.jpg"), write(folder / "labels.json", document([image()], caps()))]


def cut_off(folder: Path) -> Sequence[Path]:
    text = json.dumps(document([image()], caps()))
    return [photo(folder / "bed_1.jpg"), write(folder / "labels.json", text[: len(text) // 2])]


def fraction(nth: int) -> list[list[float]]:
    return [flat(circle(nth, scale=(1 / WIDTH, 1 / HEIGHT)))]


def scored(folder: Path) -> Sequence[Path]:
    photo(folder / "bed_1.jpg")
    return [write(folder / "labels.json", document([image()], caps(score=0.9)))]


STRANGERS = [
    Stranger(tool="CVAT", what="COCO 1.0, images/default/ beside annotations/", make=cvat),
    Stranger(
        tool="CVAT",
        what="a mask as RLE of bare counts, iscrowd 1",
        make=single(segmentation=counted, iscrowd=1),
    ),
    Stranger(
        tool="Label Studio", what="COCO, images\\, the prefix of an upload, ids from 0", make=label_studio
    ),
    Stranger(
        tool="Roboflow",
        what="train/ and valid/ with _annotations.coco.json, one name in both",
        make=roboflow,
        caps=4,
        photos=2,
    ),
    Stranger(
        tool="mmdetection", what="annotations/instances_train2017.json, train2017/ beside", make=mmdetection
    ),
    Stranger(
        tool="mmdetection",
        what="results.segm.json, RLE and scores, with the COCO file of the images",
        make=results(listed, number=7, segmentation=compressed),
        options=("--as", "predictions"),
        predictions=True,
    ),
    Stranger(
        tool="mmdetection",
        what="the same, nothing said of what it is",
        make=results(listed, number=7, segmentation=compressed),
        caps=0,
        photos=0,
        exit_code=1,
        said="carry a score, as predictions do. Say --as predictions",
    ),
    Stranger(
        tool="ultralytics",
        what="predictions.json, images called by their names",
        make=results(lambda folder: [photo(folder / "bed_1.jpg")], number="bed_1"),
        options=("--as", "predictions"),
        predictions=True,
    ),
    Stranger(
        tool="detectron2",
        what="coco_instances_results.json of images that nobody lists",
        make=results(lambda folder: [photo(folder / "bed_1.jpg")], number=900),
        options=("--as", "predictions"),
        caps=0,
        exit_code=1,
        said="together with the COCO file",
    ),
    Stranger(
        tool="any",
        what="annotations that all carry a score",
        make=scored,
        caps=0,
        photos=0,
        exit_code=1,
        said="Say --as predictions, or --as annotations",
    ),
    Stranger(tool="pycocotools", what="compressed RLE", make=single(segmentation=compressed)),
    Stranger(tool="any", what="COCO zipped, .json.gz", make=zipped),
    Stranger(
        tool="any",
        what="images called train/bed_1.jpg",
        make=single(name="train/bed_1.jpg", photo_at="train/bed_1.jpg"),
    ),
    Stranger(
        tool="any",
        what="images called ../photos/bed_1.jpg",
        make=single("labels/labels.json", "photos/bed_1.jpg", name="../photos/bed_1.jpg"),
    ),
    Stranger(
        tool="any",
        what="images called by a path of another machine",
        make=single(name="D:\\field\\2024\\bed_1.jpg"),
    ),
    Stranger(tool="any", what="one name in two folders, two photos", make=two_folders, caps=4, photos=2),
    Stranger(
        tool="any",
        what="one name in two folders, one photo",
        make=two_folders_flat,
        caps=0,
        photos=0,
        exit_code=1,
        said="put each photo into its folder",
    ),
    Stranger(
        tool="any",
        what="boxes without segmentation",
        make=single(segmentation=[]),
        shape="box",
        said="2 boxes",
    ),
    Stranger(tool="any", what="no categories", make=without_categories),
    Stranger(tool="pandas", what='ids as 1.0 and "1.0", iscrowd as "0"', make=of_text_ids),
    Stranger(
        tool="any",
        what="one flat list in place of a list of parts",
        make=single(segmentation=lambda nth: flat(circle(nth))),
    ),
    Stranger(
        tool="any",
        what="coordinates between 0 and 1",
        make=single(segmentation=fraction),
        caps=0,
        photos=0,
        exit_code=1,
        said="fractions of the photo's width and height",
    ),
    Stranger(
        tool="any",
        what="labels of a photo that is not there",
        make=without_photo,
        caps=0,
        exit_code=1,
        said="bed_1.jpg is neither in the project",
    ),
    Stranger(
        tool="any",
        what="a file cut off half way, beside its photo",
        make=cut_off,
        caps=0,
        exit_code=1,
        said="it was cut off",
    ),
]
