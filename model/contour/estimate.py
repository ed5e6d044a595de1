"""Priors from checked labels: how round caps are, how large against what is seen, how noisy their masks."""

from __future__ import annotations

from collections import defaultdict
from math import log
from typing import Any

import numpy as np
from msgspec import structs

from fairyring.model.contour.coco import ContourError, silhouettes_of
from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.harmonic import Array
from fairyring.model.contour.noise import PERFECT, RIPPLE_GAIN, ripple_powers
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.together import Together

LEAST_CAPS = 30
IN_VIEW = 0.93
"""A cap with so much of its rim in sight shows its own shape."""


def estimate_priors(document: Any, *, source: str) -> Priors:
    """Priors from a COCO document whose annotations hold visible masks and ``ellipse`` or ``circle``.

    Roundness comes from the whole outlines where they are given, else from the caps in full view; the
    harmonics from the caps in full view; size from the whole outlines against the circles around what is
    visible; noise from the free rims of all. ``source`` is kept with the figures. Raises ContourError where
    there are too few caps.
    """
    if not isinstance(document, dict) or not isinstance(document.get("annotations"), list):
        raise ContourError("This is not a COCO document: it needs lists of images and of annotations.")
    groups: dict[Any, list[dict[str, Any]]] = defaultdict(list)
    for annotation in document["annotations"]:
        if not annotation.get("iscrowd") and not annotation.get("ignore"):
            groups[annotation["image_id"]].append(annotation)
    squares, stretches, sizes, rims, ripples = [], [], [], [], []
    for image in document.get("images", []):
        width, height = image["width"], image["height"]
        annotations = groups[image["id"]]
        caps = silhouettes_of(annotations, width=width, height=height)
        whole = {cap: each for cap, each in zip(caps, annotations, strict=True) if cap.pixels}
        if not whole:
            continue
        together = fitted_image(whole, width=width, height=height).together(list(whole))
        estimate, own = together.look.estimate, together.look.own
        squares.append(_squares_in_view(together))
        rims.append(estimate.residual[together.contact.free])
        ripples.append(ripple_powers(together.rims, estimate, own).ravel())
        for annotation, around in zip(whole.values(), together.around.log_radius.tolist(), strict=True):
            axes = _axes(annotation)
            if axes is not None:
                stretches.append(log(axes[0] / axes[1]) / 2)
                sizes.append(log(axes[0] * axes[1]) / 2 - around)
    none = np.zeros((0, 2 + 2 * len(DEFAULT.wobble)))
    priors = _priors(np.concatenate([none, *squares]), np.array(stretches), np.array(sizes), source)
    return _with_noise(priors, np.concatenate(rims), np.concatenate(ripples))


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


def _axes(annotation: dict[str, Any]) -> tuple[float, float] | None:
    """Longer and shorter semi-axis of the whole outline."""
    if annotation.get("ellipse"):
        return float(annotation["ellipse"][2]), float(annotation["ellipse"][3])
    if annotation.get("circle"):
        return float(annotation["circle"][2]), float(annotation["circle"][2])
    return None


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
