"""Section 5 applied to a COCO document: the same annotations, with centres and whole outlines."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from fairyring.model.coco.annotations import Entry, is_crowd, segmentation_of, told_arcs_of
from fairyring.model.coco.document import Document, Item, annotations_by_image, value_of
from fairyring.model.coco.faults import Fault, Reported, place_of
from fairyring.model.coco.images import ImageEntry, read_images
from fairyring.model.coco.visible import counts_in, outline_in
from fairyring.model.coco.writing import rounded, shape_keys
from fairyring.model.contour.methods import DEFAULT_METHOD
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.reconstruct import reconstruct_silhouettes
from fairyring.model.contour.result import UNSEEN, Reconstruction
from fairyring.model.contour.silhouette import NOTHING, Silhouette, silhouette_of_outline
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.rle import cut_of_counts
from fairyring.model.json_files import JsonError
from fairyring.model.json_values import ValueRefusedError, shown
from fairyring.model.progress import Progress, silent

OURS = ("center", "circle", "ellipse", "center_sd", "shape", "refusal")


class ContourError(FairyringError):
    """A document that cannot be read; the sentence says why, not which file it is."""


def contour_document(
    document: Document,
    *,
    method: str = DEFAULT_METHOD,
    priors: Priors = DEFAULT,
    progress: Progress = silent,
) -> dict[str, Any]:
    """The document with, in every annotation, what `reconstruct_silhouettes` says of its mask.

    That is ``center: [x, y]``, ``ellipse: [cx, cy, a, b, theta_deg]`` or ``circle: [cx, cy, r]``,
    ``center_sd: [sx, sy]`` or None, and ``shape``; or ``center: None`` and ``refusal``, also where something
    is wrong with the annotation or its image. Keys of these names that were there before are replaced
    without being read, everything else stays. All annotations of an image, crowds apart, are each other's
    context. ``progress`` hears (images done, all, file name). Raises ContourError.
    """
    if document.images is None:
        raise ContourError("This is a list of results; give a COCO file, which lists the images too.")
    images = read_images(document, report=lambda _fault: None)
    annotations = list(document.annotations)
    groups = annotations_by_image(document)
    for done, (image_id, indices) in enumerate(groups.items()):
        entries = [_decoded(annotations[index], index) for index in indices]
        image = images.get(image_id) if image_id is not None else None
        progress(done, len(groups), "" if image is None else shown(image.keys.get("file_name", image.id)))
        for index, entry in zip(indices, _answered(entries, image, method, priors), strict=True):
            annotations[index] = entry
    return {**document.others, "images": list(map(value_of, document.images)), "annotations": annotations}


def silhouettes_of(annotations: Iterable[Entry], *, width: int, height: int) -> list[Silhouette]:
    """The silhouettes of annotations of an image of this size; empty for those without a usable mask."""
    return [_seen(annotation, width=width, height=height)[0] for annotation in annotations]


def silhouette_of(annotation: Entry, *, width: int, height: int) -> Silhouette:
    """The silhouette of an annotation of an image of this size. Raises FairyringError."""
    if is_crowd(annotation):
        raise ValueRefusedError("This is a crowd, not a cap.")
    segmentation = segmentation_of(annotation)
    if segmentation is None:
        raise ValueRefusedError("It has no visible outline.")
    told = told_arcs_of(annotation)
    if isinstance(segmentation, list):
        outline = outline_in(segmentation, width=width, height=height)
        return silhouette_of_outline(outline, width=width, height=height, told=told)
    mask, (left, top) = cut_of_counts(height, counts_in(segmentation, width=width, height=height))
    return Silhouette(np.ascontiguousarray(mask), left, top, told=told)


def _decoded(item: Item, index: int) -> Any:
    """An annotation, decoded; one that cannot be is an error, as it could not be written back."""
    try:
        return value_of(item)
    except JsonError as error:
        raise ContourError(f"{place_of('Annotation', None, index)}: {error}") from error


def _answered(entries: list[Any], image: ImageEntry | None, method: str, priors: Priors) -> list[Any]:
    """The annotations of one image with what is found; what is no object stays as it is."""
    if image is None or image.width is None or image.height is None:
        reason = "The file lists no such image with an id, a width and a height."
        return [_with(entry, UNSEEN, reason) for entry in entries]
    width, height = image.width, image.height
    caps, refusals = zip(*(_seen(entry, width=width, height=height) for entry in entries), strict=True)
    found = reconstruct_silhouettes(caps, width=width, height=height, method=method, priors=priors)
    return [_with(*each) for each in zip(entries, found, refusals, strict=True)]


def _seen(annotation: Entry, *, width: int, height: int) -> tuple[Silhouette, str | None]:
    """The mask of an annotation, or nothing and the reason why."""
    faults: list[Fault] = []
    with Reported("", faults.append):
        return silhouette_of(annotation, width=width, height=height), None
    return NOTHING, faults[0].reason


def _with(annotation: Any, found: Reconstruction, refusal: str | None) -> Any:
    if not isinstance(annotation, dict):
        return annotation
    kept = {key: value for key, value in annotation.items() if key not in OURS}
    fit = found.fit
    if fit.whole is None or fit.centre is None:
        return {**kept, "center": None, "refusal": refusal or fit.refusal}
    sd = None if fit.centre_sd is None else rounded(fit.centre_sd)
    own = {"center": rounded(fit.centre), **shape_keys(fit.whole), "center_sd": sd, "shape": found.shape}
    return kept | own
