"""COCO documents and result lists as evaluation reads them: images paired, with the caps of both sides.

Both sides come from outside. The first thing that cannot be used ends the evaluation, since figures of a part
of the caps would mislead; DocumentError says where it stands.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, NoReturn

from msgspec import Struct, structs

from fairyring.model.coco.document import Document, annotations_by_image, objects_of
from fairyring.model.coco.faults import Fault, Reported, place_of
from fairyring.model.coco.ids import Id
from fairyring.model.coco.images import ImageEntry, read_images, size_of
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.caps import CapRecord, cap_of
from fairyring.model.evaluate.image_pairs import Pairing, named_images, partners_of
from fairyring.model.json_values import base_name, shown, text


class DocumentError(FairyringError):
    """A document that cannot be evaluated; the sentence names the item, not the file."""

    side: Literal["predicted", "truth"] | None = None
    """Which of the two documents it is; None where they do not match each other."""


class Page(Struct, frozen=True, kw_only=True):
    """One image of the truth, with what was predicted there."""

    file_name: str
    """Base name of the image's file; its whole path where another image has that name."""
    width: int
    height: int
    truths: list[CapRecord]
    predictions: list[CapRecord]
    light: str | None = None
    form: str | None = None


class Paged(Struct, frozen=True, kw_only=True):
    """Two documents, image by image."""

    pages: list[Page]
    """The truth's images, in its order."""
    pairing: Pairing
    """What of both sides was not compared."""


class Truth(Struct, frozen=True, kw_only=True):
    """A truth that was read: of an annotation only what evaluation needs, so that its text can go."""

    images: dict[str, ImageEntry] | None
    """The images as ``named_images`` names them; None for a result list."""
    caps: dict[str, list[CapRecord]]
    """The caps of each image, by its name; none of a list, whose images only the predictions know."""
    listed: Document | None = None
    """A result list, which is read when the images are known."""
    masks: bool
    centres: bool


def truth_of(document: Document, *, masks: bool, centres: bool) -> Truth:
    """Reads a truth; caps as ``cap_of`` reads them. Without ``masks`` every one must have an id.

    Raises DocumentError.
    """
    with _blamed_on("truth"):
        images = _images(document)
        if images is None:
            return Truth(images=None, caps={}, listed=document, masks=masks, centres=centres)
        of_image = _by_image(document)
        caps = {
            name: _caps(document, of_image.get(image.id, []), name, image, masks=masks, centres=centres)
            for name, image in images.items()
        }
    return Truth(images=images, caps=caps, masks=masks, centres=centres)


def pages_of(predicted: Document, truth: Truth) -> Paged:
    """The truth's images, with the caps of both sides.

    Images are paired as by ``partners_of``; a result list, which names none, goes by the other side's image
    ids. Raises DocumentError, also where the two have no image in common.
    """
    with _blamed_on("predicted"):
        predicted_images, of_prediction = _images(predicted), _by_image(predicted)
    if truth.images is None and predicted_images is None:
        raise DocumentError(
            "Neither side lists images, and their sizes are needed; give a COCO file with images."
        )
    with _blamed_on("truth"):
        of_truth = _by_image(truth.listed) if truth.listed is not None else {}
    listed = truth.images if truth.images is not None else predicted_images or {}
    partners, pairing = _partners(listed, truth.images, predicted_images, of_truth, of_prediction)
    pages = []
    for name, image in listed.items():
        other = partners.get(name)
        if other is not None and size_of(other) != size_of(image):
            raise DocumentError(
                f"{name} has different sizes in the two files; they must show the same photo."
            )
        with _blamed_on("truth"):
            truths = truth.caps.get(name, [])
            if truth.listed is not None:
                truths = _caps(
                    truth.listed,
                    of_truth.get(image.id, []),
                    name,
                    image,
                    masks=truth.masks,
                    centres=truth.centres,
                )
        with _blamed_on("predicted"):
            indices = of_prediction.get(other.id, []) if other else []
            guesses = _caps(predicted, indices, name, image, masks=truth.masks, centres=truth.centres)
        pages.append(_page(name, image, truths, guesses))
    return Paged(
        pages=pages, pairing=structs.replace(pairing, swapped=True) if _seem_swapped(pages) else pairing
    )


def _seem_swapped(pages: list[Page]) -> bool:
    truths = [cap.is_scored for page in pages for cap in page.truths]
    return (
        any(truths) and all(truths) and not any(cap.is_scored for page in pages for cap in page.predictions)
    )


def _partners(
    listed: dict[str, ImageEntry],
    true_images: dict[str, ImageEntry] | None,
    predicted_images: dict[str, ImageEntry] | None,
    of_truth: dict[Id | None, list[int]],
    of_prediction: dict[Id | None, list[int]],
) -> tuple[dict[str, ImageEntry], Pairing]:
    if true_images is not None and predicted_images is not None:
        partners, pairing = partners_of(true_images, predicted_images)
        if true_images and not partners:
            raise DocumentError(
                f"The two have no image in common: the predictions are of {_first_of(predicted_images)}, "
                f"the truth of {_first_of(true_images)}."
            )
        return partners, pairing
    # One side is a list, which names images by the other's ids.
    numbers = {image.id for image in listed.values()}
    told = of_prediction if predicted_images is None else of_truth
    strange = [shown(number) for number in told if number not in numbers]
    if told and len(strange) == len(told):
        raise DocumentError(
            f"The two have no image in common: the list is of image {strange[0]}, "
            f"the other file has {_first_of(listed)}."
        )
    return dict(listed), Pairing(unknown=strange if predicted_images is None else [])


def _first_of(images: dict[str, ImageEntry]) -> str:
    first = next(iter(images), "no image")
    return first if len(images) < 2 else f"{first} and {len(images) - 1} more"


@contextmanager
def _blamed_on(side: Literal["predicted", "truth"]) -> Iterator[None]:
    try:
        yield
    except DocumentError as error:
        error.side = side
        raise


def _stop(fault: Fault) -> NoReturn:
    raise DocumentError(f"{fault.where[0].upper()}{fault.where[1:]}: {fault.reason} Mend it or leave it out.")


def _images(document: Document) -> dict[str, ImageEntry] | None:
    """The images as ``named_images`` names them; None for a result list."""
    if document.images is None:
        return None
    listed = read_images(document, report=_stop)
    for image in listed.values():
        with Reported(image.where, _stop):
            base_name(image.keys.get("file_name"))
    named: dict[str, ImageEntry] = {}
    with Reported("images", _stop):
        named = named_images(listed.values())
    for name, image in named.items():
        with Reported(f"{image.where}, {name}", _stop):
            size_of(image)
    return named


def _by_image(document: Document) -> dict[Id | None, list[int]]:
    indices = annotations_by_image(document)
    if None in indices:
        place = place_of("annotation", None, indices[None][0])
        _stop(Fault(place, "It does not say which image it belongs to."))
    return indices


def _page(name: str, image: ImageEntry, truths: list[CapRecord], predictions: list[CapRecord]) -> Page:
    width, height = size_of(image)
    return Page(
        file_name=name,
        width=width,
        height=height,
        truths=truths,
        predictions=predictions,
        light=text(image.keys.get("light")),
        form=text(image.keys.get("form")),
    )


def _caps(
    document: Document, indices: list[int], name: str, image: ImageEntry, *, masks: bool, centres: bool
) -> list[CapRecord]:
    caps = []
    width, height = size_of(image)
    for _, where, entry in objects_of("annotation", document.annotations, indices=indices, report=_stop):
        with Reported(f"{where} of {name}", _stop):
            caps.append(cap_of(entry, width=width, height=height, masks=masks, centres=centres))
    ids = {cap.id for cap in caps}
    if not masks and (None in ids or len(ids) < len(caps)):
        raise DocumentError(f"The annotations of {name} need an id each to be paired by it.")
    return caps
