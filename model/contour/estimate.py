"""Priors from checked labels: how round caps are, how large against what is seen, how noisy their masks."""

from __future__ import annotations

from collections.abc import Sequence
from math import log
from typing import NoReturn

import numpy as np
from msgspec import structs

from fairyring.model.coco.annotations import is_ignored, segmentation_of, shape_of
from fairyring.model.coco.document import Document, annotations_by_image, objects_of
from fairyring.model.coco.faults import Fault, Reported
from fairyring.model.coco.images import read_images, size_of
from fairyring.model.contour.coco import ContourError, silhouette_of
from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.harmonic import Array
from fairyring.model.contour.noise import PERFECT, RIPPLE_GAIN, ripple_powers
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.contour.together import Together, reaches_around
from fairyring.model.geometry.outline_checks import check_mark
from fairyring.model.geometry.shapes import Circle, Shape

LEAST_CAPS = 30
IN_VIEW = 0.93
"""A cap with so much of its rim in sight shows its own shape."""


def estimate_priors(document: Document, *, source: str) -> Priors:
    """Priors from a COCO document whose annotations hold visible masks and ``ellipse`` or ``circle``.

    Roundness comes from the whole outlines where they are given, else from the caps in full view; the
    harmonics from the caps in full view; size from the longest radii against the circles around what is
    visible; noise from the free rims of all. Ignored caps, and those without a visible outline, tell nothing.
    ``source`` is kept with the figures. Raises ContourError where something is wrong with the document, or
    there are too few caps.
    """
    if document.images is None:
        raise ContourError("This is a list of results; give a COCO file, which lists the images too.")
    groups = annotations_by_image(document)
    squares, stretches, sizes, rims, ripples = [], [], [], [], []
    for image in read_images(document, report=_stop).values():
        with Reported(image.where, _stop):
            size_of(image)
        width, height = size_of(image)
        wholes = _checked_caps(document, groups.get(image.id, []), width=width, height=height)
        if not wholes:
            continue
        together = fitted_image(wholes, width=width, height=height).together(list(wholes))
        estimate, own = together.look.estimate, together.look.own
        squares.append(_squares_in_view(together))
        rims.append(estimate.residual[together.contact.free])
        ripples.append(ripple_powers(together.rims, estimate, own).ravel())
        reaches = reaches_around(together.rims, together.around).tolist()
        for whole, reach in zip(wholes.values(), reaches, strict=True):
            if whole is not None:
                longer, shorter = _axes(whole)
                stretches.append(log(longer / shorter) / 2)
                sizes.append(log(longer) - reach)
    none = np.zeros((0, 2 + 2 * len(DEFAULT.wobble)))
    priors = _priors(np.concatenate([none, *squares]), np.array(stretches), np.array(sizes), source)
    return _with_noise(priors, np.concatenate(rims), np.concatenate(ripples))


def _stop(fault: Fault) -> NoReturn:
    raise ContourError(f"{fault.where}: {fault.reason}")


def _checked_caps(
    document: Document, indices: Sequence[int], *, width: int, height: int
) -> dict[Silhouette, Shape | None]:
    """The whole outline, where it is given, of every cap of an image of which something is seen."""
    wholes: dict[Silhouette, Shape | None] = {}
    for _, where, entry in objects_of("annotation", document.annotations, indices=indices, report=_stop):
        with Reported(where, _stop):
            if is_ignored(entry) or segmentation_of(entry) is None:
                continue
            cap, whole = silhouette_of(entry, width=width, height=height), shape_of(entry)
            if whole is not None:
                check_mark(whole, width=width, height=height)
            if cap.pixels:
                wholes[cap] = whole
    return wholes


def _with_noise(priors: Priors, residual: Array, ripples: Array) -> Priors:
    """With the robust deviation of the free rims' points, and the length that explains the ripples' power."""
    noise = float(np.median(np.abs(residual))) / 0.6745 if len(residual) else priors.noise
    beyond = noise**2 - PERFECT
    if beyond < PERFECT or len(ripples) == 0:
        # Of the grid's own noise there is nothing to tell the length of other noise by.
        return structs.replace(priors, noise=max(noise, 0.05))
    length = RIPPLE_GAIN * float(np.median(ripples)) / log(2) / beyond
    return structs.replace(priors, noise=noise, noise_length=min(max(length, 1.0), 200.0))


def _squares_in_view(together: Together) -> Array:
    """(m, H), expected squares of the shape parameters of the caps that can be seen all round."""
    estimate = together.look.estimate
    variance = np.diagonal(estimate.covariance, axis1=1, axis2=2)[:, 3:]
    # Clipped, for one mislabelled cap would otherwise widen the prior of all.
    square = estimate.outlines.shape.clip(-0.3, 0.3) ** 2
    return (square + variance)[together.coverage >= IN_VIEW]


def _axes(whole: Shape) -> tuple[float, float]:
    """Longer and shorter semi-axis."""
    return (whole.r, whole.r) if isinstance(whole, Circle) else (whole.a, whole.b)


def _priors(squares: Array, stretches: Array, sizes: Array, source: str) -> Priors:
    if len(squares) < LEAST_CAPS:
        raise ContourError(f"Priors need {LEAST_CAPS} caps in full view; the file has {len(squares)}.")
    seen = np.sqrt(squares.mean(axis=0))
    priors = structs.replace(
        DEFAULT,
        source=source,
        stretch=float(np.hypot(*seen[:2]) / np.sqrt(2)),
        wobble=tuple(float(np.hypot(*seen[at : at + 2]) / np.sqrt(2)) for at in range(2, len(seen), 2)),
    )
    if len(sizes) < LEAST_CAPS:
        return priors
    hidden = float(np.sqrt((stretches**2).mean() / 2)) / max(priors.stretch, 1e-3)
    return structs.replace(
        priors,
        stretch_hidden=max(1.0, hidden),
        size=float(max(np.std(sizes), 0.05)),
        size_shift=float(np.median(sizes)),
    )
