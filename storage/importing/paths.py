"""Imports photos, COCO and labelme files: what is good in one transaction; the rest is reported."""

from __future__ import annotations

import gc
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

from msgspec import Struct
from sqlalchemy import Connection

from fairyring.model.progress import Progress, silent
from fairyring.storage.cap_validity import check_name
from fairyring.storage.choices import ImportAs, ImportFormat
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import IMAGES
from fairyring.storage.formats.found import Problem
from fairyring.storage.images import set_status
from fairyring.storage.importing.entering import (
    Entered,
    Labelled,
    enter_annotations,
    enter_photo,
    enter_predictions,
    refused_as_prediction,
    tell_more,
)
from fairyring.storage.importing.intake import NOTHING_SAID, Facts, Intake, take_in
from fairyring.storage.importing.photos import Photo, photos_of_project
from fairyring.storage.importing.sources import Sources, gather
from fairyring.storage.importing.staging import Staging, staging
from fairyring.storage.predictions import add_run
from fairyring.storage.project import Project
from fairyring.storage.records import Run


class ImportReport(Struct, frozen=True, kw_only=True):
    """What an import did."""

    images: int
    """New ones."""
    images_known: int
    annotations: int
    """New ones."""
    predictions: int
    """New ones."""
    known: int
    """How many annotations or predictions were there already."""
    run: int | None
    """The run that new predictions belong to."""
    problems: list[Problem]


def import_paths(
    project: Project,
    paths: Sequence[Path],
    *,
    kind: ImportFormat = ImportFormat.auto,
    as_: ImportAs = ImportAs.annotations,
    strict: bool = False,
    link: bool = False,
    unsaid: Facts = NOTHING_SAID,
    progress: Progress = silent,
    user: str = "import",
) -> ImportReport:
    """Imports files and folders. The same again adds nothing.

    Args:
        project: where to.
        paths: photos, COCO or labelme files, folders of them.
        kind: what the paths hold.
        as_: what the shapes become.
        strict: take nothing if there is any problem.
        link: leave photos where they are instead of copying them.
        unsaid: what holds of photos where their file does not say otherwise; light and form of new ones.
        progress: called now and then; what it raises ends the import, with nothing changed.
        user: whom the journal names.

    Raises:
        StoreError: nothing can be used, or ``strict`` and something is wrong. Nothing is changed.
    """
    check_name(user, "name of a user")
    project.require_writable()
    with _no_garbage_collection():
        progress(0, 0, "Reading")
        sources = gather([Path(path) for path in paths], kind=kind)
        with project.read() as connection:
            known = photos_of_project(connection)
        intake = take_in(sources, known=known, unsaid=unsaid, progress=progress)
        if as_ == ImportAs.predictions:
            _keep_predictions(intake)
        _require_usable(intake, paths, strict=strict)
        with staging(project) as copies:
            for done, photo in enumerate(intake.new_photos):
                progress(done, len(intake.new_photos), "Copying photos")
                if not link:
                    copies.copy(photo)
            progress(0, 0, "Storing")
            return project.write(
                lambda connection: _store(connection, intake, sources, copies, as_=as_, link=link, user=user)
            )


@contextmanager
def _no_garbage_collection() -> Iterator[None]:
    """Pauses garbage collection: coordinates hold no cycles, and looking takes half the time of an import."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def _keep_predictions(intake: Intake) -> None:
    for name, caps in intake.caps.items():
        refusals = [(cap, refused_as_prediction(cap)) for cap in caps]
        intake.caps[name] = [cap for cap, reason in refusals if reason is None]
        intake.problems += [Problem(name, cap.where, reason) for cap, reason in refusals if reason]


def _require_usable(intake: Intake, paths: Sequence[Path], *, strict: bool) -> None:
    first = str(intake.problems[0]) if intake.problems else "there is no photo or file of labels in it"
    if not intake.seen:
        raise StoreError(f"Nothing was imported from {', '.join(map(str, paths))}: {first}")
    if strict and intake.problems:
        others = len(intake.problems) - 1
        raise StoreError(f"Nothing was imported, as asked: {first}" + (f" ({others} more)" if others else ""))


def _store(
    connection: Connection,
    intake: Intake,
    sources: Sources,
    copies: Staging,
    *,
    as_: ImportAs,
    link: bool,
    user: str,
) -> ImportReport:
    photos = photos_of_project(connection)
    new = [photo for photo in intake.new_photos if not _is_known(photo, photos)]
    for photo in new:
        path = str(photo.source and photo.source.resolve()) if link else f"{IMAGES}/{photo.file_name}"
        photos[photo.file_name] = enter_photo(connection, photo, path=path)
    for name in intake.seen:
        if intake.photos[name].id is not None and intake.photos[name] != photos[name]:
            tell_more(connection, intake.photos[name])
    labelled = [Labelled(photo=photos[name], caps=caps) for name, caps in intake.caps.items()]
    categories = {name: extra for d in sources.documents for name, extra in d.found.categories.items()}
    annotations, predictions, run = Entered(), Entered(), None
    if as_ == ImportAs.annotations:
        annotations = enter_annotations(connection, labelled, categories=categories, user=user)
        _set_statuses(connection, intake, photos, user=user)
    elif labelled:
        run = _run_of(connection, sources)
        predictions = enter_predictions(connection, labelled, categories=categories, run_id=run.id)
    copies.move_in()
    return ImportReport(
        images=len(new),
        images_known=len(intake.seen) - len(new),
        annotations=annotations.new,
        predictions=predictions.new,
        known=annotations.known + predictions.known,
        run=run and run.id,
        problems=intake.problems,
    )


def _set_statuses(connection: Connection, intake: Intake, photos: dict[str, Photo], *, user: str) -> None:
    for name in sorted(intake.seen):
        number, status = photos[name].id, intake.photos[name].status
        if status is not None and number is not None:
            set_status(connection, number, status, user=user)


def _is_known(photo: Photo, photos: dict[str, Photo]) -> bool:
    """Whether somebody else has imported this photo while this import was reading."""
    other = photos.get(photo.file_name)
    if other is not None and other.sha256 != photo.sha256:
        raise StoreError(f"Another image called {photo.file_name} was imported just now; import again.")
    return other is not None


def _run_of(connection: Connection, sources: Sources) -> Run:
    """The run of imported predictions; the same files always belong to the same one."""
    names = [document.path.name for document in sources.documents]
    digests = sorted(document.sha256 for document in sources.documents)
    return add_run(
        connection,
        name=names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more",
        kind="import",
        settings={"files": names[:100]},
        key=sha256("".join(digests).encode()).hexdigest(),
    )
