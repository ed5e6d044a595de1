"""What a network is trained on: labels of a project or of COCO files, and a record of which they were."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import Connection

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Outline, Polygon, polygon_of_shape
from fairyring.model.progress import Progress, silent
from fairyring.model.train.data import Example
from fairyring.storage.choices import ImportFormat
from fairyring.storage.contents import load_annotations
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import is_project
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.importing.intake import Intake, take_in
from fairyring.storage.importing.photos import Photo
from fairyring.storage.importing.sources import Sources, gather
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Annotation, Cap, Image, Status, is_complete

Item = TypeVar("Item")

NO_LABELS, NO_OUTLINES = "without labels", "without a cap that can be learnt"
NOT_APPROVED = "not approved, as others are"


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """A photo that plays no part, and why."""

    entry: dict[str, Any]
    """What ``labels.json`` says of it."""
    why: str


@dataclass(frozen=True, kw_only=True)
class Labels:
    """Labelled photos, and the record of where they came from."""

    examples: list[Example]
    splits: list[str | None]
    """The ``split`` of each example's image."""
    entries: list[dict[str, Any]]
    """What ``labels.json`` says of each example's image, the revision of every cap among it."""
    record: dict[str, Any]
    """Where they came from, for ``labels.json``."""
    left_out: list[LeftOut]
    """The photos that teach nothing."""
    others: Counter[str]
    """Numbers of labels that are of no cap, by their category."""


@dataclass(frozen=True, kw_only=True)
class _Labelled:
    """A photo and what is labelled in it."""

    path: Path
    photo: Image | Photo
    caps: list[Cap]
    status: Status | None
    """None where a file of others does not say; then all caps of a photo with labels are labelled."""
    entry: dict[str, Any]
    """What ``labels.json`` says of it."""
    has_others: bool = False
    """Whether something that is no cap is labelled in it."""


def labels_at(
    paths: Sequence[Path],
    *,
    lenient: bool = False,
    in_turn: bool = False,
    categories: Collection[str] = (),
    progress: Progress = silent,
) -> Labels:
    """The labels of a project's folder, or of one COCO file or several, as ``only_caps`` leaves them.

    Raises FairyringError.
    """
    projects = [path for path in paths if is_project(path)]
    if projects and len(paths) > 1:
        raise FairyringError(f"{projects[0]} is a project; give it alone, or COCO files only.")
    if projects:
        with open_project(projects[0]) as project:
            return labels_of_project(project, categories=categories, progress=progress)
    for path in paths:
        if path.is_dir():
            raise FairyringError(f"{path} is no project; give a project's folder or a COCO file.")
    return labels_of_coco(paths, lenient=lenient, in_turn=in_turn, categories=categories, progress=progress)


def labels_of_project(
    project: Project, *, categories: Collection[str] = (), progress: Progress = silent
) -> Labels:
    """The labels of a project: of its approved images, else of all with annotations.

    An image that nobody called annotated or approved is labelled in part. Ignored and doubtful caps, and
    those without a visible outline, are where nothing is learnt.
    Raises FairyringError for a photo that is gone or changed, and where nothing is annotated.
    """
    with project.read() as connection:
        rule, ids, reasons = _labelled(connection)
        found = [(get_image(connection, i), load_annotations(connection, i)) for i in ids]
        left_out = [
            LeftOut(entry=_entry_of(get_image(connection, i), ()), why=why) for i, why in reasons.items()
        ]
    if not found:
        raise FairyringError(f"Nothing is annotated in {project.folder} yet; annotate some images first.")
    labelled = []
    for done, (image, caps) in enumerate(found):
        progress(done, len(found), "Looking at photos")
        labelled.append(
            _Labelled(
                path=project.originals.path_of(image),
                photo=image,
                caps=[annotation.cap for annotation in caps],
                status=image.status,
                entry=_entry_of(image, caps),
            )
        )
    record = {"project": project.name, "id": project.id, "images_are": rule}
    return _labels(labelled, categories, record=record, left_out=left_out)


def labels_of_coco(
    paths: Sequence[Path],
    *,
    lenient: bool = False,
    in_turn: bool = False,
    categories: Collection[str] = (),
    progress: Progress = silent,
) -> Labels:
    """The labels of COCO files; photos are looked for beside each file and in ``images/`` beside it.

    Two files may each have a photo of one name. ``in_turn`` takes one image of each file, then the next of
    each, so that the first few are of all of them. What an import would report ends it, unless ``lenient``
    leaves such items out. Raises StoreError.
    """
    files = [_of_file(path, categories, lenient=lenient, progress=progress) for path in paths]
    joined = _in_turn if in_turn else _one_after_the_other
    return Labels(
        examples=joined([labels.examples for labels in files]),
        splits=joined([labels.splits for labels in files]),
        entries=joined([labels.entries for labels in files]),
        record={"files": [labels.record for labels in files]},
        left_out=_one_after_the_other([labels.left_out for labels in files]),
        others=sum((labels.others for labels in files), Counter()),
    )


def _of_file(path: Path, categories: Collection[str], *, lenient: bool, progress: Progress) -> Labels:
    sources = gather([path], kind=ImportFormat.coco)
    intake = take_in(sources, known=(), progress=progress)
    if intake.problems and not (lenient and intake.seen):
        others = len(intake.problems) - 1
        more = f" ({others} more; --lenient leaves such items out)" if others else " (or give --lenient)"
        raise StoreError(f"{intake.problems[0]}{more}")
    return _of_intake(sources, intake, categories)


def _one_after_the_other(lists: Sequence[list[Item]]) -> list[Item]:
    return [item for items in lists for item in items]


def _in_turn(lists: Sequence[list[Item]]) -> list[Item]:
    """Takes one item of each list, then the next of each, until all lists are used up."""
    longest = max(map(len, lists), default=0)
    return [items[place] for place in range(longest) for items in lists if place < len(items)]


def _labelled(connection: Connection) -> tuple[str, list[int], dict[int, str]]:
    """The rule by which images of a project teach, those that do, and why each of the others does not."""
    everything = list_ids(connection, ImageFilter())
    said = {*list_ids(connection, ImageFilter(status="annotated"))}
    with_caps = {*said, *list_ids(connection, ImageFilter(annotated=True))}
    approved = list_ids(connection, ImageFilter(status="approved"))
    if approved:
        reasons = {
            number: NOT_APPROVED if number in with_caps else NO_LABELS
            for number in everything
            if number not in set(approved)
        }
        return "approved", approved, reasons
    ids = [number for number in everything if number in with_caps]
    return "annotated", ids, {number: NO_LABELS for number in everything if number not in with_caps}


def _entry_of(image: Image, annotations: Sequence[Annotation]) -> dict[str, Any]:
    revisions = {annotation.uid: annotation.revision for annotation in annotations}
    return {"file_name": image.file_name, "sha256": image.sha256, "caps": revisions}


def _of_intake(sources: Sources, intake: Intake, categories: Collection[str]) -> Labels:
    labelled = []
    for name in sorted(intake.seen):
        photo = intake.photos[name]
        assert photo.source is not None, "no project was asked"
        labelled.append(
            _Labelled(
                path=photo.source,
                photo=photo,
                caps=[found.cap for found in intake.caps.get(name, [])],
                status=photo.status,
                entry={"file_name": photo.file_name, "sha256": photo.sha256},
            )
        )
    (document,) = sources.documents
    record = {"file": document.path.name, "sha256": document.sha256}
    return _labels(labelled, categories, record=record, left_out=())


def _labels(
    labelled: Sequence[_Labelled],
    categories: Collection[str],
    *,
    record: dict[str, Any],
    left_out: Sequence[LeftOut],
) -> Labels:
    """The examples of the photos that teach something, and the others with the reason."""
    labelled, others = only_caps(labelled, categories, where=record.get("file") or record["project"])
    labels = Labels(examples=[], splits=[], entries=[], record=record, left_out=list(left_out), others=others)
    for item in labelled:
        example = _example(item)
        reason = _why_left_out(example, item)
        if reason is not None:
            labels.left_out.append(LeftOut(entry=item.entry, why=reason))
            continue
        labels.examples.append(example)
        labels.splits.append(item.photo.split)
        labels.entries.append(item.entry | ({} if example.complete else {"complete": False}))
    return labels


def only_caps(
    labelled: Sequence[_Labelled], categories: Collection[str], *, where: str
) -> tuple[list[_Labelled], Counter[str]]:
    """The photos with the labels of these categories alone, and how many there are of each other one.

    Of none named: all where there is one category, of several the one that is called as ours. What is of
    another category is known to be no cap. Raises FairyringError where nobody says which are caps.
    """
    named = Counter(cap.category for item in labelled for cap in item.caps)
    wanted = {name.casefold() for name in categories} or {DEFAULT_CATEGORY}
    taught = {name for name in named if name.casefold() in wanted}
    if not categories and len(named) == 1:
        taught = {*named}
    if named and not taught:
        listed = ", ".join(sorted(named))
        raise FairyringError(
            f"The labels of {where} are of {listed}; say with --categories which of these are caps."
        )
    kept = []
    for item in labelled:
        caps = [cap for cap in item.caps if cap.category in taught]
        kept.append(replace(item, caps=caps, has_others=len(caps) < len(item.caps)))
    return kept, Counter({name: count for name, count in named.items() if name not in taught})


def _why_left_out(example: Example, item: _Labelled) -> str | None:
    said_to_be_empty = not item.caps and (item.status is not None or item.has_others)
    if example.caps or (example.complete and (example.ignored or said_to_be_empty)):
        return None
    return NO_OUTLINES if item.caps else NO_LABELS


def _example(item: _Labelled) -> Example:
    learnt = [cap for cap in item.caps if _is_learnt(cap)]
    return Example(
        path=item.path,
        width=item.photo.width,
        height=item.photo.height,
        caps=[cap.visible for cap in learnt],
        wholes=[None if isinstance(cap.mark, Polygon) else cap.mark for cap in learnt],
        ignored=[_covered(cap) for cap in item.caps if not _is_learnt(cap)],
        complete=item.status is None or is_complete(item.status),
        light=item.photo.light,
        form=item.photo.form,
        sha256=item.photo.sha256,
    )


def _is_learnt(cap: Cap) -> bool:
    return bool(cap.visible) and not (cap.ignored or cap.doubtful)


def _covered(cap: Cap) -> Outline:
    if cap.visible or cap.mark is None:
        return cap.visible
    return [cap.mark.points if isinstance(cap.mark, Polygon) else polygon_of_shape(cap.mark)]
