"""The figures of one network: success by light and form, and from image to centre."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from msgspec import convert, to_builtins

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.model.coco.document import document_of
from fairyring.model.colour.methods import Found
from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.silhouette import silhouette_of_outline
from fairyring.model.evaluate.centre_figures import evaluate_centres
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.photo import Pixels
from fairyring.model.predict.seen import Detection
from fairyring.model.progress import Progress, silent

CERTAIN = 0.5
"""Least score of the predictions whose centres are measured."""

PAPER_MASKS = {"AP": 0.9304, "AP50": 0.9906, "AP75": 0.9525, "S50": 0.9813}
PAPER_LIGHTS = {"top": 0.9800, "side": 0.9723, "dark": 0.9873}
PAPER_CDR = 0.30
"""The paper's mean CDR, percent."""

SUCCESS_FIGURES = ("S50", "S75", "S50_strict", "AP", "IoU85", "excursion")
MASK_FIGURES = ("AP", "AP50", "AP75", "AR", "P", "R", "S50", "S75", "S50_strict", "S50_small")


def predicted_document(
    detect: Callable[[Pixels], Sequence[Detection | Found]],
    photos: LabelledPhotos,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """What is detected in the photos, (height, width, 3) RGB each, as a COCO document with scores.

    Where the network says where a whole cap lies, the annotation has that as ``likely``.
    """
    annotations: list[dict[str, Any]] = []
    for done, (entry, pixels) in enumerate(photos.images()):
        progress(done, len(photos.photos), f"predicting {entry['file_name']}")
        for detection in detect(pixels):
            annotations.append(
                {
                    "id": len(annotations) + 1,
                    "image_id": entry["id"],
                    "category_id": 1,
                    "segmentation": detection.outline,
                    "score": detection.score,
                    "likely": to_builtins(getattr(detection, "whole", None)),
                }
            )
    return {"images": photos.document["images"], "annotations": annotations, "categories": []}


def success_rows(predicted: dict[str, Any], photos: LabelledPhotos) -> list[dict[str, Any]]:
    """Table 2: all caps of a set, then by light and by form, with the paper's figures beside."""
    figures = evaluate_masks(document_of(predicted), document_of(photos.document))
    rows = [_row("all", figures, PAPER_MASKS["S50"])]
    for group, papers in (("light", PAPER_LIGHTS), ("form", {}), ("size", {})):
        for value, scores in figures["groups"].get(group, {}).items():
            rows.append(_row(f"{group} {value}", scores, papers.get(value)))
    return rows


def centre_rows(predicted: dict[str, Any], photos: LabelledPhotos) -> list[dict[str, Any]]:
    """Table 3: how far the centres of certain predictions, as they are stored, lie from the true ones."""
    found = predicted | {"annotations": list(_with_centres(predicted))}
    rows = []
    for without_doubt in (False, True):
        truth = _without_doubt(photos.document) if without_doubt else photos.document
        if without_doubt and truth == photos.document:
            continue
        figures = evaluate_centres(document_of(found), document_of(truth))
        cdr, px = figures["cdr"], figures["px"]
        rows.append(
            {
                "set": photos.name + (", certain caps" if without_doubt else ""),
                "CDR_%_mean": _rounded(cdr["mean"]),
                "median": _rounded(cdr["median"]),
                "p95": _rounded(cdr["p95"]),
                "px_mean": _rounded(px["mean"]),
                "px_median": _rounded(px["median"]),
                "bias_px": [round(side, 3) for side in figures["bias_px"] or ()],
                "matched": figures["matched"],
                "missed": figures["missed"],
                "extra": figures["extra"],
                "paper_CDR_%": PAPER_CDR,
            }
        )
    return rows


def _with_centres(predicted: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The annotations that are certain, each with the centre that the caps of an image have together."""
    for image in predicted["images"]:
        size = {"width": image["width"], "height": image["height"]}
        caps = [
            cap
            for cap in predicted["annotations"]
            if cap["image_id"] == image["id"] and cap["score"] >= CERTAIN
        ]
        seen = [
            silhouette_of_outline(
                cap["segmentation"], **size, likely=convert(cap["likely"], LikelyEllipse | None)
            )
            for cap in caps
        ]
        found = fitted_image(seen, **size).reconstructions(seen)
        for cap, it in zip(caps, found, strict=True):
            yield cap | {"center": it.fit.centre and list(it.fit.centre)}


def mask_row(name: str, figures: dict[str, Any]) -> dict[str, Any]:
    """The figures of ``evaluate masks`` in one row."""
    return {"network": name} | {key: _rounded(figures.get(key)) for key in MASK_FIGURES}


def _row(name: str, scores: dict[str, Any], paper: float | None) -> dict[str, Any]:
    count = scores.get("count", scores.get("counts", {}).get("truths"))
    figures = {key: _rounded(scores.get(key)) for key in SUCCESS_FIGURES}
    return {"caps_of": name, "caps": count, **figures, "paper_S50": paper}


def _without_doubt(document: dict[str, Any]) -> dict[str, Any]:
    """The document with doubtful caps ignored, so that they count neither way."""
    caps = [cap | {"ignore": True} if cap.get("doubt") else cap for cap in document["annotations"]]
    return document | {"annotations": caps}


def _rounded(figure: float | None) -> float | None:
    return None if figure is None else round(figure, 4)
