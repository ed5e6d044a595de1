"""Section 5 applied to a COCO document: the same annotations, with centres and whole outlines."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np

from fairyring.model.contour.methods import DEFAULT_METHOD
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.reconstruct import reconstruct_silhouettes
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import NOTHING, Silhouette, silhouette_of_outline
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.rle import checked_counts, cut_of_counts
from fairyring.model.geometry.shapes import Circle, GeometryError
from fairyring.model.progress import Progress, silent

OURS = ("center", "circle", "ellipse", "center_sd", "shape", "refusal")


class ContourError(FairyringError):
    """A document that cannot be worked on; the sentence says why, not which file it is."""


def contour_document(
    document: Any,
    *,
    method: str = DEFAULT_METHOD,
    priors: Priors = DEFAULT,
    progress: Progress = silent,
) -> dict[str, Any]:
    """The document with, in every annotation, what `reconstruct_silhouettes` says of its mask.

    That is ``center: [x, y]``, ``ellipse: [cx, cy, a, b, theta_deg]`` or ``circle: [cx, cy, r]``,
    ``center_sd: [sx, sy]`` or None, and ``shape``; or ``center: None`` and ``refusal``. Keys of these names
    that were there before are replaced, everything else stays. All annotations of an image, crowds apart, are
    each other's context. ``progress`` hears (images done, all, file name). Raises ContourError.
    """
    images = _images(document)
    groups: dict[Any, list[int]] = defaultdict(list)
    for index, annotation in enumerate(document["annotations"]):
        image_id = annotation.get("image_id") if isinstance(annotation, dict) else None
        if not isinstance(image_id, int | str) or image_id not in images:
            raise ContourError(f"Annotation {index + 1} does not belong to an image of the file.")
        groups[image_id].append(index)
    annotations = list(document["annotations"])
    for done, (image_id, indices) in enumerate(groups.items()):
        width, height, name = images[image_id]
        progress(done, len(groups), name)
        caps, refusals = zip(
            *(_seen(annotations[i], width=width, height=height) for i in indices), strict=True
        )
        found = reconstruct_silhouettes(caps, width=width, height=height, method=method, priors=priors)
        for index, reconstruction, refusal in zip(indices, found, refusals, strict=True):
            annotations[index] = _with(annotations[index], reconstruction, refusal)
    return {**document, "annotations": annotations}


def silhouettes_of(annotations: list[dict[str, Any]], *, width: int, height: int) -> list[Silhouette]:
    """What is seen of each annotation of an image of this size; nothing for those that are no mask."""
    return [_seen(annotation, width=width, height=height)[0] for annotation in annotations]


def _images(document: Any) -> dict[Any, tuple[int, int, str]]:
    """Width, height and file name by image id."""
    if not isinstance(document, dict) or not all(
        isinstance(document.get(key), list) for key in ("images", "annotations")
    ):
        raise ContourError("This is not a COCO document: it needs lists of images and of annotations.")
    images = {}
    for image in document["images"]:
        size = [image.get("width"), image.get("height")] if isinstance(image, dict) else []
        good = len(size) == 2 and all(type(side) is int and side >= 1 for side in size)
        if not good or not isinstance(image.get("id"), int | str):
            raise ContourError("An image of the file lacks its id, its width or its height.")
        images[image["id"]] = (size[0], size[1], str(image.get("file_name", image["id"])))
    return images


def _seen(annotation: dict[str, Any], *, width: int, height: int) -> tuple[Silhouette, str | None]:
    """The mask of an annotation, or nothing and the reason why."""
    segmentation = annotation.get("segmentation")
    if annotation.get("iscrowd") == 1:
        return NOTHING, "This is a crowd, not a cap."
    try:
        if isinstance(segmentation, list):
            outline = check_outline(segmentation, width=width, height=height)
            return silhouette_of_outline(outline, width=width, height=height), None
        rows, columns, counts = checked_counts(segmentation)
        if (rows, columns) != (height, width):
            return NOTHING, f"Its mask is not of the image's size, {width} × {height}."
        mask, (left, top) = cut_of_counts(rows, counts)
    except GeometryError as error:
        return NOTHING, str(error)
    return Silhouette(np.ascontiguousarray(mask), left, top), None


def _with(annotation: dict[str, Any], found: Reconstruction, refusal: str | None) -> dict[str, Any]:
    kept = {key: value for key, value in annotation.items() if key not in OURS}
    fit = found.fit
    if fit.whole is None or fit.centre is None:
        return {**kept, "center": None, "refusal": refusal or fit.refusal}
    whole = fit.whole
    if isinstance(whole, Circle):
        outline = {"circle": _rounded(whole.cx, whole.cy, whole.r)}
    else:
        outline = {"ellipse": _rounded(whole.cx, whole.cy, whole.a, whole.b, whole.theta_deg)}
    sd = None if fit.centre_sd is None else _rounded(*fit.centre_sd)
    return {**kept, "center": _rounded(*fit.centre), **outline, "center_sd": sd, "shape": found.shape}


def _rounded(*figures: float) -> list[float]:
    return [round(figure, 4) for figure in figures]
