"""How well a network knows the quality of its outlines: against their true IoU."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.model.geometry.raster import iou_matrix, rle_of_outline
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.scale import detect_at_its_scale
from fairyring.model.progress import Progress

LEAST_SCORE = 0.3
"""Least score of the predictions that are looked at: those that `fairyring predict` stores."""
FOUND_IOU, FINE_IOU, SURE = 0.5, 0.85, 0.9
Figures = NDArray[np.float64]


def quality_rows(predictor: Predictor, photos: LabelledPhotos, *, progress: Progress) -> list[dict[str, Any]]:
    """Rank correlations of quality and score with the true IoU, of all predictions and of those on a cap.

    The true IoU of a prediction is that with the cap it is most like; those in ignored regions are left out.
    """
    parts = []
    for done, (entry, pixels) in enumerate(photos.images()):
        progress(done, len(photos.photos), f"predicting {entry['file_name']}")
        size = {"height": entry["height"], "width": entry["width"]}
        caps = [cap for cap in photos.document["annotations"] if cap["image_id"] == entry["id"]]
        found = [one for one in detect_at_its_scale(predictor, pixels) if one.score >= LEAST_SCORE]
        masks = [one.rle for one in found]
        real, unclear = (
            iou_matrix(
                [rle_of_outline(c["segmentation"], **size) for c in caps if bool(c.get("ignore")) is ignored],
                masks,
            ).max(0, initial=0)
            for ignored in (False, True)
        )
        known = [np.nan if one.quality is None else one.quality for one in found]
        figures = np.array([known, [one.score for one in found], real.tolist()], np.float64).reshape(3, -1)
        parts.append(figures[:, real >= unclear])
    figures = np.concatenate(parts, axis=1)
    on_a_cap = figures[:, figures[2] >= FOUND_IOU]
    return [_row(photos.name, "all", *figures), _row(photos.name, "on a cap", *on_a_cap)]


def _row(name: str, of: str, quality: Figures, score: Figures, iou: Figures) -> dict[str, Any]:
    loose = iou < FINE_IOU
    return {
        "set": name,
        "predictions": of,
        "count": len(iou),
        "rank_quality": _rounded(rank_correlation(quality, iou)),
        "rank_score": _rounded(rank_correlation(score, iou)),
        "IoU_mean": _mean(iou),
        "quality_mean": _mean(quality),
        "quality_off_by": _mean(np.abs(quality - iou)),
        "IoU<.85": int(loose.sum()),
        "of_those_score>=.9": int((loose & (score >= SURE)).sum()),
    }


def rank_correlation(ones: Figures, others: Figures) -> float:
    """Spearman's: the correlation of the ranks (n,) of two lists of figures; equal figures share a rank."""
    if len(ones) < 2 or not np.isfinite([ones, others]).all():
        return np.nan
    one, other = (ranks - ranks.mean() for ranks in map(_ranks, (ones, others)))
    return float(one @ other / np.sqrt((one @ one) * (other @ other)))


def _ranks(figures: Figures) -> Figures:
    _, places, counts = np.unique(figures, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return ((2 * last - counts + 1) / 2)[places]


def _mean(figures: Figures) -> float | None:
    return _rounded(float(figures.mean())) if len(figures) else None


def _rounded(figure: float) -> float | None:
    return None if np.isnan(figure) else round(figure, 4)
