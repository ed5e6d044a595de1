"""The second half of an import: all that was read and checked is stored, in one transaction."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256

from msgspec import Struct, structs
from sqlalchemy import Connection

from fairyring.storage.choices import KnownCaps
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import IMAGES
from fairyring.storage.formats.found import FoundCategory, Problem
from fairyring.storage.importing.changing import edits_of, record
from fairyring.storage.importing.comparing import Compared, compare, is_as_compared
from fairyring.storage.importing.entering import (
    KeptNumbers,
    Labelled,
    enter_annotations,
    enter_photos,
    enter_predictions,
    tell_more,
)
from fairyring.storage.importing.intake import Intake
from fairyring.storage.importing.photos import Photo, photos_of_project
from fairyring.storage.importing.sources import Sources
from fairyring.storage.importing.staging import Staging
from fairyring.storage.predictions import add_run
from fairyring.storage.records import Run
from fairyring.storage.statuses import set_status


class ImportReport(Struct, frozen=True, kw_only=True):
    """What an import did."""

    images: int
    """New ones."""
    images_known: int
    annotations: int = 0
    """New ones."""
    predictions: int = 0
    """New ones."""
    known: int = 0
    """How many annotations or predictions were there already."""
    changed: int = 0
    """Of how many known annotations the files say something else."""
    gone: int = 0
    """How many annotations of the images no file has."""
    edits: int = 0
    """How many edits brought the project to what the files say."""
    run: int | None = None
    """The run that new predictions belong to."""
    unscored: bool = False
    """Whether no prediction carries a score: a person may have labelled what was taken for a model's."""
    polygons: int = 0
    """How many polygons of labelme there were, which may be taken in two ways."""
    boxes: int = 0
    """How many of the new ones are boxes, to be corrected."""
    problems: list[Problem]
    images_otherwise: int = 0
    """Of how many known images the files say another light, form or split."""
    useless: list[str] = []
    """Files of labels of which no label could be used."""


class Parcel(Struct, frozen=True, kw_only=True):
    """What is to be stored, and how."""

    sources: Sources
    intake: Intake
    compared: Sequence[Compared] | None
    """Of annotations, what they are to the project's; None for what becomes a run."""
    known_caps: KnownCaps
    link: bool
    """Photos stay where they are."""
    kept: KeptNumbers
    by_second: bool
    """Whether a second annotator labelled what becomes a run; else a model said it."""
    user: str


def store(connection: Connection, parcel: Parcel, copies: Staging) -> ImportReport:
    """Stores a parcel; its photos get their names just before that is committed."""
    intake = parcel.intake
    photos = photos_of_project(connection)
    new = [photo for photo in intake.new_photos if not _is_known(photo, photos)]
    by_path = {_path_of(photo, link=parcel.link): photo for photo in new}
    photos |= {photo.file_name: photo for photo in enter_photos(connection, by_path, kept=parcel.kept)}
    for name in intake.seen | intake.copies:
        if intake.photos[name].id is not None and intake.photos[name] != photos[name]:
            tell_more(connection, intake.photos[name])
    report = ImportReport(
        images=len(new),
        images_known=len(intake.seen) - len(new),
        polygons=sum(document.found.polygons for document in parcel.sources.documents),
        problems=intake.problems,
        useless=intake.useless,
        images_otherwise=len(intake.told_otherwise),
    )
    if parcel.compared is None:
        report = _store_predictions(connection, parcel, photos, report)
    else:
        report = _store_annotations(connection, parcel, photos, report)
        _set_statuses(connection, intake, photos, user=parcel.user)
    copies.move_in()
    return report


def _path_of(photo: Photo, *, link: bool) -> str:
    """As the project keeps it."""
    linked = link and not photo.within_labels
    return str(photo.source and photo.source.resolve()) if linked else f"{IMAGES}/{photo.file_name}"


def _store_annotations(
    connection: Connection, parcel: Parcel, photos: dict[str, Photo], report: ImportReport
) -> ImportReport:
    assert parcel.compared is not None
    compared = [_as_now(connection, each, photos[each.photo.file_name]) for each in parcel.compared]
    labelled = [Labelled(photo=photos[each.photo.file_name], caps=each.new) for each in compared]
    categories = _categories(parcel)
    entered = enter_annotations(
        connection, labelled, categories=categories, kept=parcel.kept, user=parcel.user
    )
    edits = [edit for each in compared for edit in edits_of(each, parcel.known_caps)]
    record(connection, edits, user=parcel.user)
    boxes = sum(cap.is_box for each in compared for cap in each.new)
    return structs.replace(
        report,
        boxes=boxes,
        annotations=entered.new,
        known=entered.known + sum(each.known for each in compared),
        changed=sum(len(each.changed) for each in compared),
        gone=sum(len(each.gone) for each in compared),
        edits=len(edits),
    )


def _as_now(connection: Connection, compared: Compared, photo: Photo) -> Compared:
    """What was compared before the transaction began; anew where somebody was quicker."""
    return (
        compared if is_as_compared(connection, compared, photo) else compare(connection, photo, compared.caps)
    )


def _store_predictions(
    connection: Connection, parcel: Parcel, photos: dict[str, Photo], report: ImportReport
) -> ImportReport:
    labelled = [Labelled(photo=photos[name], caps=caps) for name, caps in parcel.intake.caps.items()]
    if not labelled:
        return report
    run = _run_of(connection, parcel.sources, by_second=parcel.by_second)
    categories = _categories(parcel)
    entered = enter_predictions(connection, labelled, categories=categories, kept=parcel.kept, run_id=run.id)
    scored = any(cap.score is not None for item in labelled for cap in item.caps)
    return structs.replace(
        report,
        predictions=entered.new,
        known=entered.known,
        run=run.id,
        unscored=not parcel.by_second and not scored and entered.new + entered.known > 0,
    )


def _categories(parcel: Parcel) -> dict[str, FoundCategory]:
    """The categories of all files by name; the first file's where several list one."""
    named: dict[str, FoundCategory] = {}
    for document in parcel.sources.documents:
        named |= {name: each for name, each in document.found.categories.items() if name not in named}
    return named


def _set_statuses(connection: Connection, intake: Intake, photos: dict[str, Photo], *, user: str) -> None:
    for name in sorted(intake.seen):
        photo, status = photos[name], intake.photos[name].status
        if photo.id is not None and status not in (None, photo.status):
            set_status(connection, photo.id, status, user=user)


def _is_known(photo: Photo, photos: dict[str, Photo]) -> bool:
    """Whether somebody else has imported this photo while this import was reading."""
    other = photos.get(photo.file_name)
    if other is not None and other.sha256 != photo.sha256:
        raise StoreError(f"Another image called {photo.file_name} was imported just now; import again.")
    return other is not None


def _run_of(connection: Connection, sources: Sources, *, by_second: bool) -> Run:
    """The run of imported predictions; the same files always belong to the same one."""
    names = [document.path.name for document in sources.documents]
    digests = sorted(document.sha256 for document in sources.documents)
    return add_run(
        connection,
        name=names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more",
        kind="second" if by_second else "import",
        settings={"files": names[:100]},
        key=sha256("".join(digests).encode()).hexdigest(),
    )
