"""Whole outlines and centres of an image's caps from what is visible of them (section 5), by any method."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.model.contour.methods import DEFAULT_METHOD, METHODS, MaskedImage
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.result import UNSEEN, Reconstruction
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.geometry.shapes import Outline


def reconstruct(
    caps: Sequence[Outline],
    *,
    width: int,
    height: int,
    method: str = DEFAULT_METHOD,
    priors: Priors = DEFAULT,
) -> list[Reconstruction]:
    """The whole outlines of an image's caps, given the visible outlines of all of them.

    ``width`` and ``height`` are the image's. ``method`` is one of `METHODS`; KeyError for any other. A cap
    that cannot be reconstructed is refused with a sentence, and its neighbours are not troubled by it.
    """
    silhouettes = [silhouette_of_outline(cap, width=width, height=height) for cap in caps]
    return reconstruct_silhouettes(silhouettes, width=width, height=height, method=method, priors=priors)


def reconstruct_silhouettes(
    caps: Sequence[Silhouette],
    *,
    width: int,
    height: int,
    method: str = DEFAULT_METHOD,
    priors: Priors = DEFAULT,
) -> list[Reconstruction]:
    """As `reconstruct`, from masks."""
    fit = METHODS[method]
    there = [cap for cap in caps if cap.pixels]
    image = MaskedImage(caps=there, width=width, height=height, priors=priors)
    found = iter(fit(image) if there else [])
    return [next(found) if cap.pixels else UNSEEN for cap in caps]
