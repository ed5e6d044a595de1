"""Two people's labels of the same photos: how far they agree, and a third version made of both."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from msgspec import Struct, structs

from fairyring.model.coco.annotations import DOUBTFUL, is_doubtful, is_ignored
from fairyring.model.coco.document import Document, objects_of
from fairyring.model.coco.faults import Fault, Reported
from fairyring.model.coco.ids import Id, id_of
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.bootstrap import Interval, mean_interval
from fairyring.model.evaluate.centres import Comparison, Pair, compare
from fairyring.model.evaluate.kappa import Kappa, kappa_of
from fairyring.model.evaluate.pages import Page, pages_of, truth_of

AGREE_FROM = 0.85
"""IoU from which on two outlines of a cap are taken for the same."""
Entry = dict[str, Any]


class Side(Struct, frozen=True, kw_only=True):
    """One cap as one of the two labelled it."""

    entry: Entry
    ignored: bool
    doubtful: bool


class Both(Struct, frozen=True, kw_only=True):
    """A cap that both labelled."""

    page: int
    first: Side
    second: Side
    pair: Pair

    def agrees(self, least_iou: float) -> bool:
        """Whether the outlines are the same to this IoU, and the flags, too."""
        flags = self.first.ignored == self.second.ignored and self.first.doubtful == self.second.doubtful
        return flags and (self.pair.iou or 0.0) >= least_iou


class Versions(Struct, frozen=True, kw_only=True):
    """Two versions of the labels of the same photos, cap by cap."""

    pages: list[Page]
    both: list[Both]
    only_first: list[tuple[int, Side]]
    """With the place of their image, as of ``only_second``."""
    only_second: list[tuple[int, Side]]


class ImageAgreement(Struct, frozen=True, kw_only=True):
    """How far the two agree on one image."""

    file_name: str
    matched: int
    only_first: int
    only_second: int
    iou: float | None
    """Mean of the caps that both labelled."""
    px: float | None
    """Mean distance of their centres."""


class Agreement(Struct, frozen=True, kw_only=True):
    """How far two people agree."""

    matched: int
    only_first: int
    only_second: int
    iou: Interval | None
    """Mean IoU of the outlines of caps that both labelled."""
    px: Interval | None
    """Mean distance of their centres, pixels."""
    cdr: Interval | None
    """The same as CDR, percent (Eq. 10)."""
    ignored: Kappa
    doubtful: Kappa
    images: list[ImageAgreement]


def versions_of(first: Document, second: Document) -> Versions:
    """Pairs the caps of two COCO documents by their outlines; ignored caps, too.

    Images are those of the first, paired by name. Raises FairyringError for what is not such a document, and
    where a cap has no id of its own.
    """
    pages = pages_of(second, truth_of(first, masks=True, centres=True)).pages
    return versions_between(pages, sides_of(first), sides_of(second))


def versions_between(pages: list[Page], first: Mapping[Id, Side], second: Mapping[Id, Side]) -> Versions:
    """Pairs the caps of pages by their outlines; ignored caps, too.

    Args:
        pages: the first one's caps as truths, the second one's as predictions, each with an id.
        first: the caps of the first by id.
        second: those of the second.
    """
    found = Versions(pages=pages, both=[], only_first=[], only_second=[])
    for place, page in enumerate(pages):
        add_page(
            found,
            place,
            _compared(page),
            [first[_known(cap.id)] for cap in page.truths],
            [second[_known(cap.id)] for cap in page.predictions],
        )
    return found


def add_page(
    versions: Versions, place: int, compared: Comparison, first: Sequence[Side], second: Sequence[Side]
) -> None:
    """Adds the caps of a page, as a comparison pairs those of the first and of the second."""
    versions.both.extend(
        Both(page=place, first=first[pair.truth], second=second[pair.prediction], pair=pair)
        for pair in compared.pairs
    )
    versions.only_first.extend((place, first[number]) for number in compared.missed)
    versions.only_second.extend((place, second[number]) for number in compared.extra)


def agreement_of(versions: Versions) -> Agreement:
    """How far the two agree, overall and by image; intervals of 95 %."""
    both = versions.both
    return Agreement(
        matched=len(both),
        only_first=len(versions.only_first),
        only_second=len(versions.only_second),
        iou=_mean([(each.pair.iou, each.page) for each in both]),
        px=_mean([(each.pair.error.px, each.page) for each in both if each.pair.error]),
        cdr=_mean([(each.pair.error.cdr, each.page) for each in both if each.pair.error]),
        ignored=kappa_of([(each.first.ignored, each.second.ignored) for each in both]),
        doubtful=kappa_of([(each.first.doubtful, each.second.doubtful) for each in both]),
        images=[_of_image(versions, place) for place in range(len(versions.pages))],
    )


def adjudicated(first: Document, versions: Versions, *, least_iou: float = AGREE_FROM) -> dict[str, Any]:
    """A third version: what both agree on as the first has it, all else as doubtful, to be decided.

    Args:
        first: the document that the versions begin with.
        versions: what ``versions_of`` made of it and the other one.
        least_iou: IoU from which on two outlines are taken for the same.
    """
    images = [entry for _, _, entry in objects_of("image", first.images or [], report=_stop)]
    entries = [
        each.first.entry if each.agrees(least_iou) else _doubted(each.first.entry) for each in versions.both
    ]
    entries += [_doubted(side.entry) for _, side in versions.only_first]
    by_name = _image_ids(images, versions)
    used = [entry["id"] for entry in entries]
    last = max((number for number in used if isinstance(number, int)), default=0)
    for nth, (place, side) in enumerate(versions.only_second, start=1):
        own = {"id": last + nth, "image_id": by_name[place]}
        entries.append(_doubted({key: value for key, value in side.entry.items() if key != "uid"} | own))
    return first.others | {"images": images, "annotations": entries}


def _compared(page: Page) -> Comparison:
    truths = [structs.replace(cap, ignored=False) for cap in page.truths]
    return compare(truths, page.predictions, width=page.width, height=page.height)


def sides_of(document: Document) -> dict[Id, Side]:
    """The caps of a document by id. Raises FairyringError where one has no id of its own."""
    sides: dict[Id, Side] = {}
    for _, where, entry in objects_of("annotation", document.annotations, report=_stop):
        with Reported(where, _stop):
            number = id_of(entry.get("id"))
            if number is None or number in sides:
                raise FairyringError("Every cap needs an id of its own to be compared with another version.")
            sides[number] = Side(entry=entry, ignored=is_ignored(entry), doubtful=is_doubtful(entry))
    return sides


def _known(number: Id | None) -> Id:
    assert number is not None, "documents with caps that have no id were refused before"
    return number


def _image_ids(images: Sequence[Entry], versions: Versions) -> dict[int, Any]:
    """The id in the first document of the image at each place; both are in the same order."""
    return dict(zip(range(len(versions.pages)), (image["id"] for image in images), strict=True))


def _doubted(entry: Entry) -> Entry:
    return {key: value for key, value in entry.items() if key not in DOUBTFUL} | {"doubt": True}


def _of_image(versions: Versions, place: int) -> ImageAgreement:
    both = [each for each in versions.both if each.page == place]
    ious = [each.pair.iou for each in both if each.pair.iou is not None]
    distances = [each.pair.error.px for each in both if each.pair.error]
    return ImageAgreement(
        file_name=versions.pages[place].file_name,
        matched=len(both),
        only_first=sum(each == place for each, _ in versions.only_first),
        only_second=sum(each == place for each, _ in versions.only_second),
        iou=float(np.mean(ious)) if ious else None,
        px=float(np.mean(distances)) if distances else None,
    )


def _mean(figures: Sequence[tuple[float | None, int]]) -> Interval | None:
    known = list(_those_known(figures))
    values = np.array([figure for figure, _ in known], np.float64)
    return mean_interval(values, np.array([place for _, place in known], np.int64))


def _those_known(figures: Sequence[tuple[float | None, int]]) -> Iterator[tuple[float, int]]:
    for figure, place in figures:
        if figure is not None:
            yield figure, place


def _stop(fault: Fault) -> None:
    raise FairyringError(f"{fault.where}: {fault.reason}")
