"""Whole outlines of predicted caps: by the rim alone, by the network alone, and by both together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.app.bench.network.tables import CERTAIN
from fairyring.model.coco.annotations import shape_of
from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.evaluate.centres import CentreError, centre_error
from fairyring.model.geometry.raster import iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import Centre, centre_of_shape, diameter_of_shape
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import detect_at_its_scale
from fairyring.model.progress import Progress

IN_SIGHT = ((0.0, 1.01), (0.95, 1.01), (0.6, 0.95), (0.3, 0.6), (0.0, 0.3))
"""Shares of a cap in sight that a row is for, the upper end not included; the first are all caps."""
LEAST_IOU = 0.5


@dataclass(frozen=True, kw_only=True)
class _Cap:
    """A true cap that was found."""

    in_sight: float
    """Share of it."""
    errors: Mapping[str, CentreError]
    """Of its centre, by what said where that is."""
    deviations: Mapping[str, float]
    """Of the centre, in standard deviations (root of the mean of x² and y²), likewise."""


def whole_rows(predictor: Predictor, photos: LabelledPhotos, *, progress: Progress) -> list[dict[str, Any]]:
    """CDR by share in sight and by way; the same caps in every way."""
    caps: list[_Cap] = []
    for done, (entry, pixels) in enumerate(photos.images()):
        progress(done, len(photos.photos), f"predicting {entry['file_name']}")
        size = {"width": entry["width"], "height": entry["height"]}
        found = [one for one in detect_at_its_scale(predictor, pixels) if one.score >= CERTAIN]
        likely = [one.whole for one in found if one.whole is not None]
        if len(likely) < len(found) or not found:
            continue
        alone = [silhouette_of_outline(one.outline, **size) for one in found]
        ways = {
            "rim": _fitted(alone, **size),
            "network": [(one.parameters[:2], one.centre_sd) for one in likely],
            "both": _fitted([replace(cap, likely=it) for cap, it in zip(alone, likely, strict=True)], **size),
        }
        truths = [
            cap
            for cap in photos.document["annotations"]
            if cap["image_id"] == entry["id"] and not cap.get("ignore") and not cap.get("doubt")
        ]
        masks = [rle_of_outline(cap["segmentation"], **size) for cap in truths]
        overlap = iou_matrix(masks, [one.rle for one in found])
        for nth, truth in enumerate(truths):
            best = int(overlap[nth].argmax())
            whole = shape_of(truth)
            if overlap[nth, best] >= LEAST_IOU and whole is not None:
                said = {way: each[best] for way, each in ways.items()}
                caps.append(_compared(said, centre_of_shape(whole), diameter_of_shape(whole), truth, **size))
    return [
        row
        for low, high in IN_SIGHT
        if (chosen := [cap for cap in caps if low <= cap.in_sight < high])
        for row in _rows(photos.name, f"{low:g} – {min(high, 1):g}", chosen)
    ]


Said = tuple[Centre, tuple[float, float]]
"""A centre, and its standard deviation along x and y."""


def _fitted(shown: Sequence[Silhouette], *, width: int, height: int) -> list[Said]:
    image = fitted_image(shown, width=width, height=height)
    fits = [one.fit for one in image.reconstructions(shown)]
    return [(fit.centre or (np.nan, np.nan), fit.centre_sd or (np.nan, np.nan)) for fit in fits]


def _compared(
    said: Mapping[str, Said],
    true: Centre,
    diameter: float,
    truth: dict[str, Any],
    *,
    width: int,
    height: int,
) -> _Cap:
    errors = {
        way: centre_error(centre, true, width=width, height=height, diameter=diameter)
        for way, (centre, _) in said.items()
    }
    deviations = {
        way: float(np.hypot(errors[way].dx / sd[0], errors[way].dy / sd[1]) / 2**0.5)
        for way, (_, sd) in said.items()
    }
    return _Cap(in_sight=truth.get("visible_fraction", 1.0), errors=errors, deviations=deviations)


def _rows(name: str, in_sight: str, caps: Sequence[_Cap]) -> list[dict[str, Any]]:
    rows = []
    for way in caps[0].errors:
        cdr = np.array([cap.errors[way].cdr for cap in caps])
        px = np.array([cap.errors[way].px for cap in caps])
        off = np.array([cap.deviations[way] for cap in caps])
        rows.append(
            {
                "set": name,
                "in_sight": in_sight,
                "caps": len(caps),
                "by": way,
                "CDR_%_mean": round(float(cdr.mean()), 4),
                "median": round(float(np.median(cdr)), 4),
                "p95": round(float(np.quantile(cdr, 0.95)), 4),
                "px_mean": round(float(px.mean()), 3),
                "error_in_sd": round(float(np.sqrt(np.mean(np.minimum(off, 10) ** 2))), 2),
            }
        )
    return rows
