"""COCO files on their way into the store. ``model.coco`` reads them, and lists the keys that are ours.

Every fault is collected, and what is good beside it taken. Keys that are not known are kept, and written back
by an export.
"""

from __future__ import annotations

from collections import Counter
from pathlib import PurePosixPath
from typing import Any

from msgspec import UNSET, structs

from fairyring.model.coco.annotations import (
    DOUBTFUL,
    IGNORED,
    TOLD_ARCS,
    Entry,
    centre_of,
    centre_sd_of,
    is_doubtful,
    is_ignored,
    is_marked,
    mark_of,
    order_of,
    outline_of_box,
    own_id,
    quality_of,
    score_of,
    segmentation_of,
    shape_of,
    told_arcs_of,
)
from fairyring.model.coco.categories import category_of, listed_categories, name_of_category
from fairyring.model.coco.document import (
    Document,
    FormatError,
    annotations_by_image,
    objects_of,
    parse_document,
)
from fairyring.model.coco.faults import Fault, Reported
from fairyring.model.coco.ids import Id, id_of
from fairyring.model.coco.images import ImageEntry, by_path, read_images
from fairyring.model.geometry.shapes import Mark, Polygon
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.model.json_values import ValueRefusedError, flag, kept, shown, text
from fairyring.model.light_and_form import FORMS, LIGHTS
from fairyring.model.splits import split_called
from fairyring.storage.cap_validity import MAX_ORDER
from fairyring.storage.formats.found import Found, FoundCap, FoundCategory, FoundImage, Problem
from fairyring.storage.formats.fractions import require_pixels
from fairyring.storage.records import STATUSES, Cap, Status

IMAGE_KEYS = {
    *("id", "file_name", "width", "height", "sha256", "light", "form", "split"),
    *("license", "status", "partial"),
}
CATEGORY_KEYS = {"id", "name", "keypoints", "skeleton"}
ANNOTATION_KEYS = {
    *("id", "image_id", "category_id", "segmentation", "bbox", "area", "iscrowd", "score", "uid"),
    *("ignore", "ignored", "doubt", "doubtful", "order", "center", "circle", "ellipse", "mark", "marked"),
    *("segmentation_of", "occlude_rate", "refusal", "mark_sd", TOLD_ARCS),
}
OWN_ANNOTATION_KEYS = ANNOTATION_KEYS | {"keypoints", "num_keypoints", "amodal_segmentation"}
"""Of an annotation of our own export, which derives the last three; where others wrote them they are kept."""


def parse_coco(data: bytes, *, file: str) -> Found:
    """The images and caps of a COCO file.

    What is wrong with single items is in ``problems``.

    Raises:
        FairyringError: it is not a COCO file at all; the sentence does not name it.
    """
    document = parse_document(data)
    faults: list[Fault] = []
    categories = listed_categories(document)
    images = _images(document, faults) if document.images is not None else _images_of_results(document)
    caps = _caps(document, images, categories, faults)
    require_pixels(cap for of_image in caps.values() for cap in of_image)
    named = _categories(document, categories, faults)
    return Found(
        file=file,
        images=[structs.replace(image, caps=caps.get(own, [])) for own, image in images.items()],
        problems=[Problem(file, fault.where, fault.reason) for fault in faults],
        categories=named,
        labels=len(document.annotations),
        all_scored=_all_scored(caps),
    )


def _all_scored(caps: dict[Id, list[FoundCap]]) -> bool:
    return any(caps.values()) and all(cap.score is not None for of_image in caps.values() for cap in of_image)


def _images(document: Document, faults: list[Fault]) -> dict[Id, FoundImage]:
    """The images by id, in the order of the file."""
    licenses = _licenses(document)
    images: dict[Id, FoundImage] = {}
    written = by_path(read_images(document, report=faults.append), report=faults.append)
    names = Counter(PurePosixPath(path).name for path in written)
    for path, entry in written.items():
        with Reported(entry.where, faults.append):
            image = _image(path, entry, licenses, faults)
            several = names[PurePosixPath(path).name] > 1
            images[entry.id] = structs.replace(image, one_of_several=several)
    return images


def _images_of_results(document: Document) -> dict[Id, FoundImage]:
    """The images that a list of results speaks of: it only calls them by a number or a name."""
    called = [own for own in annotations_by_image(document) if own is not None]
    if not called:
        raise FormatError("This is a list without results: nothing in it names its image by image_id.")
    return {own: FoundImage(where=f"image {shown(own)}", file_name="", called=own) for own in called}


def _image(path: str, entry: ImageEntry, licenses: dict[Id | None, Any], faults: list[Fault]) -> FoundImage:
    keys = entry.keys
    extra = _others(keys, IMAGE_KEYS)
    if "license" in keys:
        extra["license"] = licenses.get(id_of(keys["license"]), keys["license"])
    for key, allowed in (("light", LIGHTS), ("form", FORMS)):
        if keys.get(key) is not None and keys[key] not in allowed:
            extra[key] = keys[key]
            faults.append(Fault(entry.where, f"The {key} is none of {', '.join(allowed)}; it was left out."))
    return FoundImage(
        where=entry.where,
        file_name=path,
        id=entry.id if isinstance(entry.id, int) else None,
        width=entry.width,
        height=entry.height,
        light=keys.get("light") if keys.get("light") in LIGHTS else None,
        form=keys.get("form") if keys.get("form") in FORMS else None,
        split=_split(keys),
        status=_status(keys),
        extra=_kept(extra, entry.where, faults),
    )


def _split(keys: dict[str, Any]) -> str | None:
    """Ours, where it is known by another word; else as the file has it."""
    said = text(keys.get("split"))
    return split_called(said) or said


def _status(keys: dict[str, Any]) -> Status | None:
    """What the file says of how far the image is; whatever it says, one labelled in part is to do."""
    if flag(keys.get("partial"), "partial"):
        return "new"
    # Other programs have words of their own.
    return keys.get("status") if keys.get("status") in STATUSES else None


def _caps(
    document: Document,
    images: dict[Id, FoundImage],
    categories: dict[Id, dict[str, Any]],
    faults: list[Fault],
) -> dict[Id, list[FoundCap]]:
    """The caps by the id of their image."""
    caps: dict[Id, list[FoundCap]] = {own: [] for own in images}
    lost: Counter[Id | None] = Counter()
    ids: Counter[Id | None] = Counter()
    for _, where, entry in objects_of("annotation", document.annotations, report=faults.append):
        ids[own_id(entry)] += 1
        image_id = id_of(entry.get("image_id"))
        if image_id is None or image_id not in images:
            lost[image_id] += 1
            continue
        with Reported(where, faults.append):
            caps[image_id].append(_cap(entry, where, category_of(entry, categories), faults))
    faults += [_lost(image_id, count) for image_id, count in lost.items()]
    faults += [
        Fault(f"annotation {shown(own)}", f"{count} annotations have this id; it is that of the first.")
        for own, count in ids.items()
        if own is not None and count > 1
    ]
    return caps


def _lost(image_id: Id | None, count: int) -> Fault:
    if image_id is None:
        return Fault("", f"Of {count} annotations it is not said which image they belong to.")
    return Fault(
        f"image {shown(image_id)}", f"It is missing or was left out, and {count} annotations with it."
    )


def _cap(entry: Entry, where: str, category: str, faults: list[Fault]) -> FoundCap:
    segmentation = segmentation_of(entry)
    shape, marked = shape_of(entry), is_marked(entry)
    mark: Mark | None = (mark_of(entry) or shape) if marked else None
    if entry.get("segmentation_of") == "mark" and mark is not None:
        segmentation = None
    box = None if segmentation is not None or mark is not None else outline_of_box(entry)
    extra = _others(entry, OWN_ANNOTATION_KEYS if "marked" in entry else ANNOTATION_KEYS)
    quality = quality_of(entry)
    if quality is not None:
        extra.pop("quality")
    if isinstance(mark, Polygon) and shape is None:
        extra.pop("amodal_segmentation", None)
    return FoundCap(
        where=where,
        cap=Cap(
            visible=segmentation if isinstance(segmentation, list) else box or [],
            mark=mark,
            ignored=is_ignored(entry),
            doubtful=is_doubtful(entry) or box is not None,
            order=_order(entry, where, faults),
            category=category,
            arcs=_told_arcs(entry, where, faults) or UNSET,
        ),
        score=score_of(entry),
        quality=quality,
        marked=marked,
        whole=shape,
        centre=centre_of(entry),
        centre_sd=centre_sd_of(entry),
        uid=entry["uid"] if isinstance(entry.get("uid"), str) else None,
        id=own if isinstance(own := own_id(entry), int) else None,
        tells_ignored=any(key in entry for key in IGNORED),
        # Exports of ours write it where it holds.
        tells_doubtful=box is None and ("marked" in entry or any(key in entry for key in DOUBTFUL)),
        is_mask=isinstance(segmentation, dict),
        is_box=box is not None,
        rle=segmentation if isinstance(segmentation, dict) else None,
        extra=_kept(extra, where, faults),
    )


def _order(entry: Entry, where: str, faults: list[Fault]) -> int | None:
    """The overlap order; one that makes no sense is reported and left out, and the cap is kept."""
    try:
        order = order_of(entry)
    except ValueRefusedError as error:
        faults.append(Fault(where, str(error)))
        return None
    if order is not None and abs(order) > MAX_ORDER:
        faults.append(Fault(where, f"The overlap order lies between -{MAX_ORDER} and {MAX_ORDER}."))
        return None
    return order


def _told_arcs(entry: Entry, where: str, faults: list[Fault]) -> list[ToldArc]:
    """What is said of pieces of the outline; what makes no sense is reported and left out."""
    with Reported(where, faults.append):
        return told_arcs_of(entry)
    return []


def _licenses(document: Document) -> dict[Id | None, Any]:
    """The licences by id; of several with one id the first."""
    entries = document.others.get("licenses")
    licenses: dict[Id | None, Any] = {}
    for entry in entries if isinstance(entries, list) else ():
        own = id_of(entry.get("id")) if isinstance(entry, dict) else None
        if own is not None:
            licenses.setdefault(own, entry)
    return licenses


def _categories(
    document: Document, with_id: dict[Id, dict[str, Any]], faults: list[Fault]
) -> dict[str, FoundCategory]:
    """The categories by name, also those without an id; of several with one name or one id the first."""
    listed = document.others.get("categories")
    entries = listed if isinstance(listed, list) else []
    named: dict[str, FoundCategory] = {}
    for _, where, entry in objects_of("category", entries, report=faults.append):
        own = id_of(entry.get("id"))
        with Reported(where, faults.append):
            name = name_of_category(entry)
            if own is None:
                faults.append(Fault(where, f"{name} has no id, so nothing can be of it; it gets one here."))
            elif with_id[own] != entry:
                raise ValueRefusedError(f"Another category has its id; {name} was left out.")
            extra = _kept(_others(entry, CATEGORY_KEYS), f"category {name}", faults)
            named.setdefault(name, FoundCategory(id=own if isinstance(own, int) else None, extra=extra))
    return named


def _kept(extra: dict[str, Any], where: str, faults: list[Fault]) -> dict[str, Any]:
    return kept(extra, left_out=lambda reason: faults.append(Fault(where, reason)))


def _others(entry: dict[str, Any], known: set[str]) -> dict[str, Any]:
    return {key: value for key, value in entry.items() if key not in known}
