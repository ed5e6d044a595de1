"""The test sets of the network: rendered beds that no training has seen, and hand-checked photos."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fairyring.model import photo
from fairyring.model.coco.annotations import shape_of
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Shape
from fairyring.model.json_files import read_json
from fairyring.model.photo import Pixels
from fairyring.model.progress import Progress
from fairyring.model.scene.dataset import DOCUMENT, write_beds
from fairyring.model.scene.presets import preset
from fairyring.model.scene.settings import Settings
from fairyring.model.train.data import Example

TEST_BEDS = {"paper": (48, 3003), "farm": (20, 3001)}
"""Number of test beds and their seed, by preset. Training and validation have other seeds."""
TRAINING_SEEDS = {"farm": 1001, "default": 1002, "paper": 1003}


@dataclass(frozen=True, kw_only=True)
class LabelledPhotos:
    """A COCO document with its photos."""

    name: str
    document: dict[str, Any]
    photos: list[Path]
    """Photos of the document's images, in their order."""

    def images(self) -> Iterator[tuple[dict[str, Any], Pixels]]:
        """Each entry of the document with its photo, (height, width, 3) RGB."""
        for entry, path in zip(self.document["images"], self.photos, strict=True):
            yield entry, photo.read(path)[:, :, ::-1].copy()

    def only(self, key: str, value: str) -> LabelledPhotos:
        """The images whose ``key`` (light, form) has this value."""
        chosen = [nth for nth, entry in enumerate(self.document["images"]) if entry.get(key) == value]
        return replace(self.at(chosen), name=value)

    def at(self, places: Sequence[int]) -> LabelledPhotos:
        """The images at these places of the document, and their annotations."""
        images = [self.document["images"][place] for place in places]
        numbers = {entry["id"] for entry in images}
        caps = [cap for cap in self.document["annotations"] if cap["image_id"] in numbers]
        return LabelledPhotos(
            name=self.name,
            document=self.document | {"images": images, "annotations": caps},
            photos=[self.photos[place] for place in places],
        )


def rendered(name: str, folder: Path, *, count: int | None = None, progress: Progress) -> LabelledPhotos:
    """The test beds of a preset, rendered into ``folder`` unless they are there already."""
    all_of_them, seed = TEST_BEDS[name]
    # Fewer of them have a folder of their own: one of all would be cut down.
    out = folder / (f"test_{name}" if count is None else f"test_{name}_{count}")
    write_beds(out, preset(name), count=count or all_of_them, seed=seed, resume=True, progress=progress)
    return _read(name, out / DOCUMENT)


def _as_it_is(settings: Settings) -> Settings:
    return settings


def rendered_for_training(
    folder: Path, count: int, progress: Progress, *, changed: Callable[[Settings], Settings] = _as_it_is
) -> list[LabelledPhotos]:
    """So many beds of each training preset, rendered into ``folder`` unless they are there already.

    ``changed`` says how the preset's settings are changed before.
    """
    sets = []
    for name, seed in TRAINING_SEEDS.items():
        out = folder / f"train_{name}"
        write_beds(out, changed(preset(name)), count=count, seed=seed, resume=True, progress=progress)
        sets.append(_read(name, out / DOCUMENT))
    return sets


def checked(folder: Path) -> LabelledPhotos:
    """The hand-checked photos of a folder with ``checked.json`` and ``images/``."""
    return _read("checked photos", folder / "checked.json")


def examples_of(photos: LabelledPhotos) -> list[Example]:
    """The photos as examples to learn from, all their caps labelled."""
    caps: dict[Any, list[list[list[float]]]] = defaultdict(list)
    wholes: dict[Any, list[Shape | None]] = defaultdict(list)
    for cap in photos.document["annotations"]:
        caps[cap["image_id"]].append(cap["segmentation"])
        wholes[cap["image_id"]].append(shape_of(cap))
    return [
        Example(
            path=path,
            width=entry["width"],
            height=entry["height"],
            caps=caps[entry["id"]],
            wholes=wholes[entry["id"]],
        )
        for entry, path in zip(photos.document["images"], photos.photos, strict=True)
    ]


def _read(name: str, labels: Path) -> LabelledPhotos:
    document = read_json(labels)
    photos = [labels.parent / "images" / entry["file_name"] for entry in document["images"]]
    missing = [path for path in photos if not path.exists()]
    if missing:
        raise FairyringError(f"{missing[0]} is missing, which {labels} speaks of; put it there.")
    return LabelledPhotos(name=name, document=document, photos=photos)
