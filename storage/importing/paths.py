"""Imports photos, COCO and labelme files: what is good in one transaction; the rest is reported."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from fairyring.model.garbage import garbage_left_alone
from fairyring.model.progress import Progress, silent
from fairyring.storage.cap_validity import check_name
from fairyring.storage.choices import ImportAs, ImportFormat, KnownCaps, Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import Problem
from fairyring.storage.importing.comparing import Compared, compare
from fairyring.storage.importing.entering import refused_as_prediction
from fairyring.storage.importing.intake import NOTHING_SAID, Facts, Intake, take_in
from fairyring.storage.importing.photos import photos_of_project
from fairyring.storage.importing.sources import Sources, gather
from fairyring.storage.importing.split_folders import split_folders
from fairyring.storage.importing.staging import staging
from fairyring.storage.importing.storing import ImportReport, Parcel, store
from fairyring.storage.project import Project
from fairyring.storage.taken_out import numbers_taken_out


def import_paths(
    project: Project,
    paths: Sequence[Path],
    *,
    kind: ImportFormat = ImportFormat.auto,
    as_: ImportAs | None = None,
    polygons: Polygons = Polygons.visible,
    known_caps: KnownCaps = KnownCaps.tell,
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
        as_: what the shapes become; None makes annotations of them, and asks where all carry a score.
        polygons: what the polygons of labelme files are.
        known_caps: what becomes of annotations that the project has already.
        strict: take nothing if there is any problem.
        link: leave photos where they are instead of copying them.
        unsaid: what holds of photos where their file does not say otherwise; light and form of new ones.
        progress: called now and then; what it raises ends the import, with nothing changed.
        user: whom the journal names.

    Raises:
        UnsaidError: the labels look like predictions, and nobody has said what they are.
        StoreError: nothing can be used, or ``strict`` and something is wrong. Nothing is changed.
    """
    check_name(user, "name of a user")
    project.require_writable()
    with garbage_left_alone(), TemporaryDirectory(prefix="fairyring-") as scratch:
        progress(0, 0, "Reading")
        sources = gather([Path(path) for path in paths], kind=kind, polygons=polygons)
        as_ = as_ or _require_said(sources)
        with project.read() as connection:
            known = photos_of_project(connection)
        intake = take_in(
            sources,
            known=known.values(),
            folder=project.folder,
            scratch=Path(scratch),
            unsaid=unsaid,
            split_of=split_folders(paths),
            update=known_caps in (KnownCaps.update, KnownCaps.replace),
            progress=progress,
        )
        if as_ != ImportAs.annotations:
            _keep_predictions(intake)
        _require_usable(intake, paths, strict=strict)
        compared = _compare(project, intake, progress) if as_ == ImportAs.annotations else None
        with staging(project) as copies:
            for done, photo in enumerate(intake.new_photos):
                progress(done, len(intake.new_photos), "Copying photos")
                if not link or photo.within_labels:
                    copies.copy(photo)
            progress(0, 0, "Storing")
            parcel = Parcel(
                sources=sources,
                intake=intake,
                compared=compared,
                known_caps=known_caps,
                link=link,
                kept=numbers_taken_out(project),
                by_second=as_ == ImportAs.second,
                user=user,
            )
            return project.write(lambda connection: store(connection, parcel, copies))


class UnsaidError(StoreError):
    """Files whose labels all carry a score, as predictions do, and nobody has said what they are."""


def _require_said(sources: Sources) -> ImportAs:
    for document in sources.documents:
        if document.found.all_scored:
            raise UnsaidError(
                f"{document.path}: all its {document.found.labels} annotations carry a score, as predictions "
                "do. Say --as predictions, or --as annotations if people have checked them."
            )
    return ImportAs.annotations


def _keep_predictions(intake: Intake) -> None:
    for name, caps in intake.caps.items():
        refusals = [(cap, refused_as_prediction(cap)) for cap in caps]
        intake.caps[name] = [cap for cap, reason in refusals if reason is None]
        intake.problems += [Problem(cap.file, cap.where, reason) for cap, reason in refusals if reason]


def _require_usable(intake: Intake, paths: Sequence[Path], *, strict: bool) -> None:
    first = str(intake.problems[0]) if intake.problems else "there is no photo or file of labels in it"
    if not intake.seen:
        of_one = intake.problems and [str(path) for path in paths] == [intake.problems[0].file]
        whence = "" if of_one else f" from {', '.join(map(str, paths))}"
        raise StoreError(f"Nothing was imported{whence}: {first}")
    if strict and intake.problems:
        others = len(intake.problems) - 1
        raise StoreError(f"Nothing was imported, as asked: {first}" + (f" ({others} more)" if others else ""))


def _compare(project: Project, intake: Intake, progress: Progress) -> list[Compared]:
    compared = []
    with project.read() as connection:
        for done, (name, caps) in enumerate(intake.caps.items()):
            progress(done, len(intake.caps), "Comparing")
            compared.append(compare(connection, intake.photos[name], caps))
    return compared
