"""What a network is trained on: labels of a project or of COCO files, and a record of which they were."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import Connection

from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Outline, Polygon, polygon_of_shape
from fairyring.model.progress import Progress, silent
from fairyring.model.train.data import Example
from fairyring.model.train.split import split_by_source
from fairyring.storage.choices import ImportFormat
from fairyring.storage.contents import load_annotations
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import is_project
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.importing.intake import Intake, take_in
from fairyring.storage.importing.sources import Sources, gather
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Annotation, Cap, Image

Item = TypeVar("Item")

FEWEST_TO_DIVIDE = 4
"""Least number of images of which some are kept for validation."""
VALIDATION, TEST = ("val", "valid", "validation"), ("test",)
"""Values of an image's ``split`` that mean validation and test; all other images are for training."""


@dataclass(frozen=True, kw_only=True)
class Labels:
    """Labelled photos, and the record of where they came from."""

    examples: list[Example]
    splits: list[str | None]
    """The ``split`` of each example's image."""
    record: dict[str, Any]
    """The images, and the revision of every cap, for ``labels.json``."""


def labels_at(
    paths: Sequence[Path],
    *,
    lenient: bool = False,
    in_turn: bool = False,
    progress: Progress = silent,
) -> Labels:
    """The labels of a project's folder, or of one COCO file or several. Raises FairyringError."""
    projects = [path for path in paths if is_project(path)]
    if projects and len(paths) > 1:
        raise FairyringError(f"{projects[0]} is a project; give it alone, or COCO files only.")
    if projects:
        with open_project(projects[0]) as project:
            return labels_of_project(project, progress=progress)
    for path in paths:
        if path.is_dir():
            raise FairyringError(f"{path} is no project; give a project's folder or a COCO file.")
    return labels_of_coco(paths, lenient=lenient, in_turn=in_turn, progress=progress)


def labels_of_project(project: Project, *, progress: Progress = silent) -> Labels:
    """The labels of a project: of its approved images, else of all with annotations.

    Ignored and doubtful caps, and those without a visible outline, are where nothing is learnt.
    Raises FairyringError for a photo that is gone or changed, and where nothing is annotated.
    """
    with project.read() as connection:
        rule, ids = _labelled(connection)
        labelled = [(get_image(connection, i), load_annotations(connection, i)) for i in ids]
    if not labelled:
        raise FairyringError(f"Nothing is annotated in {project.folder} yet; annotate some images first.")
    examples = []
    for done, (image, caps) in enumerate(labelled):
        progress(done, len(labelled), "Looking at photos")
        examples.append(_example(project.originals.path_of(image), image, [a.cap for a in caps]))
    entries = [_entry_of(image, caps) for image, caps in labelled]
    return Labels(
        examples=examples,
        splits=[image.split for image, _ in labelled],
        record={"project": project.name, "id": project.id, "images_are": rule, "images": entries},
    )


def labels_of_coco(
    paths: Sequence[Path],
    *,
    lenient: bool = False,
    in_turn: bool = False,
    progress: Progress = silent,
) -> Labels:
    """The labels of COCO files; photos are looked for beside each file and in ``images/`` beside it.

    Two files may each have a photo of one name. ``in_turn`` takes one image of each file, then the next of
    each, so that the first few are of all of them. What an import would report ends it, unless ``lenient``
    leaves such items out. Raises StoreError.
    """
    files = [_of_file(path, lenient=lenient, progress=progress) for path in paths]
    joined = _in_turn if in_turn else _one_after_the_other
    return Labels(
        examples=joined([labels.examples for labels in files]),
        splits=joined([labels.splits for labels in files]),
        record={"files": [labels.record for labels in files]},
    )


def _of_file(path: Path, *, lenient: bool, progress: Progress) -> Labels:
    sources = gather([path], kind=ImportFormat.coco)
    intake = take_in(sources, known={}, light=None, form=None, progress=progress)
    if intake.problems and not (lenient and intake.seen):
        others = len(intake.problems) - 1
        more = f" ({others} more; --lenient leaves such items out)" if others else " (or give --lenient)"
        raise StoreError(f"{intake.problems[0]}{more}")
    return _of_intake(sources, intake)


def _one_after_the_other(lists: Sequence[list[Item]]) -> list[Item]:
    return [item for items in lists for item in items]


def _in_turn(lists: Sequence[list[Item]]) -> list[Item]:
    """Takes one item of each list, then the next of each, until all lists are used up."""
    longest = max(map(len, lists), default=0)
    return [items[place] for place in range(longest) for items in lists if place < len(items)]


def divided(labels: Labels, validation: Labels | None, *, seed: int) -> tuple[list[Example], list[Example]]:
    """The examples for training and those for validation; test images are in neither.

    Validated is ``validation`` where given, else what ``split`` names so, else a seeded three tenths of four
    images and more.
    """
    pairs = list(zip(labels.examples, labels.splits, strict=True))
    learnt = [example for example, split in pairs if split not in VALIDATION + TEST]
    if validation is not None:
        return learnt, validation.examples
    checked = [example for example, split in pairs if split in VALIDATION]
    if checked or len(learnt) < FEWEST_TO_DIVIDE:
        return learnt, checked
    # By the whole path: photos of two data sets may have one name.
    sides = split_by_source([example.path.as_posix() for example in learnt], seed=seed)
    return (
        [example for example, side in zip(learnt, sides, strict=True) if side == "train"],
        [example for example, side in zip(learnt, sides, strict=True) if side == "val"],
    )


def _labelled(connection: Connection) -> tuple[str, list[int]]:
    approved = list_ids(connection, ImageFilter(status="approved"))
    if approved:
        return "approved", approved
    said = list_ids(connection, ImageFilter(status="annotated"))
    annotated = {*said, *list_ids(connection, ImageFilter(annotated=True))}
    return "annotated", [i for i in list_ids(connection, ImageFilter()) if i in annotated]


def _entry_of(image: Image, annotations: Sequence[Annotation]) -> dict[str, Any]:
    revisions = {annotation.uid: annotation.revision for annotation in annotations}
    return {"file_name": image.file_name, "sha256": image.sha256, "caps": revisions}


def _of_intake(sources: Sources, intake: Intake) -> Labels:
    photos = [intake.photos[name] for name in sorted(intake.seen)]
    examples = []
    for photo in photos:
        assert photo.source is not None, "no project was asked"
        caps = [found.cap for found in intake.caps.get(photo.file_name, [])]
        examples.append(_example(photo.source, photo, caps))
    entries = [{"file_name": photo.file_name, "sha256": photo.sha256} for photo in photos]
    (document,) = sources.documents
    return Labels(
        examples=examples,
        splits=[photo.split for photo in photos],
        record={"file": document.path.name, "sha256": document.sha256, "images": entries},
    )


def _example(path: Path, image: Any, caps: Sequence[Cap]) -> Example:
    learnt = [cap.visible for cap in caps if _is_learnt(cap)]
    left = [_covered(cap) for cap in caps if not _is_learnt(cap)]
    return Example(
        path=path,
        width=image.width,
        height=image.height,
        caps=learnt,
        ignored=left,
        light=image.light,
        form=image.form,
    )


def _is_learnt(cap: Cap) -> bool:
    return bool(cap.visible) and not (cap.ignored or cap.doubtful)


def _covered(cap: Cap) -> Outline:
    if cap.visible or cap.mark is None:
        return cap.visible
    return [cap.mark.points if isinstance(cap.mark, Polygon) else polygon_of_shape(cap.mark)]
