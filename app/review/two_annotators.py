"""What two people labelled in the same photos: the annotations, and the version of somebody else.

That is a run, where it was imported, or a COCO file. Runs hold no caps to be ignored, so how
far the two agree on these can be told of a file alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from msgspec import structs
from sqlalchemy import Connection

from fairyring.app.caps.filling_in import fill_in
from fairyring.app.review.reviewed import ReviewedImage, reviewed_images, worked_on
from fairyring.model.coco.annotations import is_doubtful
from fairyring.model.coco.document import Document
from fairyring.model.coco.ids import Id
from fairyring.model.coco.images import ImageEntry
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.agreement import (
    Agreement,
    Side,
    Versions,
    add_page,
    agreement_of,
    sides_of,
    versions_between,
)
from fairyring.model.evaluate.centres import compare
from fairyring.model.evaluate.kappa import kappa_of
from fairyring.model.evaluate.pages import Truth, pages_of
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Prediction, Run
from fairyring.storage.runs import images_seen_by


def agreement_on_image(connection: Connection, image_id: int, second: Run) -> Agreement:
    """How far the annotations of an image agree with the version of somebody else.

    Annotations to be ignored, and what the second version has there, are left out. Centres are compared where
    the first has a mark. Raises StoreError where the project has no such image.
    """
    return _with_run(reviewed_images(connection, [image_id], run=second))


def agreement_with_run(project: Project, second: Run, *, images: str = "*") -> Agreement:
    """The same over all images that somebody worked on and the second version is of.

    Its files may list images without a cap: there all caps of the first are missed.

    Args:
        project: whose annotations.
        second: the version of somebody else.
        images: only images of these file names, which may hold ``*`` and ``?``.

    Raises:
        FairyringError: there is no such image.
    """
    fill_in(project)
    with project.read() as connection:
        seen = {image.id for image in images_seen_by(connection, second.id)}
        numbers = [image.id for image in worked_on(connection, images=images, among=seen)[0]]
        if not numbers:
            raise FairyringError(f"There is no image with labels that {second.name} is of, too.")
        return _with_run(reviewed_images(connection, numbers, run=second))


def agreement_with_labels(project: Project, second: Document, *, images: str = "*") -> Agreement:
    """The same with a document, whose caps to be ignored are compared like all others.

    Args:
        project: whose annotations.
        second: what somebody else labelled; of its images those count that the project has labels of.
        images: only images of these file names, which may hold ``*`` and ``?``.

    Raises:
        FairyringError: there is no such image, or the document cannot be read.
    """
    fill_in(project)
    with project.read() as connection:
        touched, _ = worked_on(connection, images=images)
        found = list(reviewed_images(connection, [image.id for image in touched]))
    paged = pages_of(second, _truth(found))
    lacking = {*paged.pairing.unpredicted}
    pages = [page for page in paged.pages if page.file_name not in lacking]
    ours: Mapping[Id, Side] = {
        each.uid: side
        for image in found
        for each, side in zip(image.annotations, _first_sides(image.annotations), strict=True)
    }
    return agreement_of(versions_between(pages, ours, sides_of(second)))


def _truth(found: Iterable[ReviewedImage]) -> Truth:
    """The annotations as evaluation has a truth of a document."""
    entries, caps = {}, {}
    for each in found:
        image = each.image
        entries[image.file_name] = ImageEntry(
            id=image.id,
            where=image.file_name,
            width=image.width,
            height=image.height,
            keys={"file_name": image.file_name},
        )
        caps[image.file_name] = each.page.truths
    return Truth(images=entries, caps=caps, masks=True, centres=True)


def _with_run(images: Iterable[ReviewedImage]) -> Agreement:
    versions = Versions(pages=[], both=[], only_first=[], only_second=[])
    for place, each in enumerate(images):
        page = each.page
        compared = compare(page.truths, page.predictions, width=page.width, height=page.height)
        first, second = _first_sides(each.annotations), _second_sides(each.predictions)
        add_page(versions, place, compared, first, second)
        versions.pages.append(structs.replace(page, truths=[], predictions=[]))
    return structs.replace(agreement_of(versions), ignored=kappa_of([]))


def _first_sides(annotations: Sequence[Annotation]) -> list[Side]:
    return [Side(entry={}, ignored=each.cap.ignored, doubtful=each.cap.doubtful) for each in annotations]


def _second_sides(predictions: Sequence[Prediction]) -> list[Side]:
    return [Side(entry={}, ignored=False, doubtful=is_doubtful(each.extra)) for each in predictions]
