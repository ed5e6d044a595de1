"""How far each contour method's centres are from the truth, how well it knows that, and how long it takes.

Clusters are made by the recipe of ``model.scene.clusters`` with other seeds than anything was tuned on. The
time is compared with what anybody would write: ``findContours`` and ``fitEllipse`` on the same cropped masks.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from app.bench.timing import Row
from app.commands.contour import read_json
from model.contour.coco import silhouettes_of
from model.contour.methods import METHODS
from model.contour.reconstruct import Reconstruction, reconstruct_silhouettes
from model.contour.silhouette import Silhouette
from model.scene.clusters import Recipe, make_cluster

SEED = 70_000
HEAVY = 0.6
"""A cap with less of its area in sight counts as heavily hidden."""


@dataclass(frozen=True, slots=True)
class Truth:
    """An image's masks with the true centres (n, 2) and the visible shares of the caps (n,)."""

    caps: list[Silhouette]
    centres: np.ndarray
    visible: np.ndarray
    counts: np.ndarray
    """(n,), which caps count; the others are context alone."""
    width: int
    height: int


def run(*, quick: bool = False, real: Path | None = None) -> list[Row]:
    """One row a set of masks and method; also of ``real``, a COCO file of checked photos or its folder."""
    count = 1 if quick else 20
    rows = []
    for noise in (0.0, 1.0, 2.0):
        images = [_made(SEED + index, noise) for index in range(count)]
        rows += _rows(f"clusters, noisy by {noise:.0f} px", images)
    if real is not None:
        rows += _rows(f"{real.name}, without doubtful caps", _checked(real))
    return rows


def _made(seed: int, noise: float) -> Truth:
    cluster = make_cluster(seed=seed, recipe=Recipe(noise=noise))
    return Truth(
        caps=[Silhouette(cap.mask, cap.left, cap.top) for cap in cluster.caps],
        centres=np.array([(cap.whole.cx, cap.whole.cy) for cap in cluster.caps]),
        visible=np.array([cap.visible_fraction for cap in cluster.caps]),
        counts=np.ones(len(cluster.caps), np.bool_),
        width=cluster.width,
        height=cluster.height,
    )


def _checked(path: Path) -> list[Truth]:
    """The images of a COCO file whose caps hold ``center``, ``visible_fraction``, ``doubt``, ``ignore``."""
    document = read_json(path / "checked.json" if path.is_dir() else path)
    images = []
    for image in document["images"]:
        caps = [each for each in document["annotations"] if each["image_id"] == image["id"]]
        images.append(
            Truth(
                caps=silhouettes_of(caps, width=image["width"], height=image["height"]),
                centres=np.array([cap["center"] for cap in caps], np.float64),
                visible=np.array([cap.get("visible_fraction", 1.0) for cap in caps]),
                counts=np.array([not (cap.get("ignore") or cap.get("doubt")) for cap in caps]),
                width=image["width"],
                height=image["height"],
            )
        )
    return images


def _rows(masks: str, images: Sequence[Truth]) -> list[Row]:
    plain = sum(_plain(image.caps) for image in images)
    return [_row(masks, method, images, plain) for method in METHODS]


def _row(masks: str, method: str, images: Sequence[Truth], plain: float) -> Row:
    def fit(image: Truth) -> list[Reconstruction]:
        return reconstruct_silhouettes(image.caps, width=image.width, height=image.height, method=method)

    found = [fit(image) for image in images]
    taken = sum(_seconds(lambda image=image: fit(image)) for image in images)
    errors = [_errors(image, each) for image, each in zip(images, found, strict=True)]
    cdr, scores, visible = (np.concatenate([each[part] for each in errors]) for part in range(3))
    heavy = cdr[visible < HEAVY]
    caps = sum(len(image.caps) for image in images)
    return {
        "masks": masks,
        "method": method,
        "caps": len(cdr),
        "cdr_mean": round(float(cdr.mean()), 4),
        "cdr_median": round(float(np.median(cdr)), 4),
        "cdr_p95": round(float(np.percentile(cdr, 95)), 3),
        "cdr_heavily_hidden": round(float(heavy.mean()), 3) if len(heavy) else None,
        "rms_z": round(float(np.sqrt(np.mean(scores**2))), 2) if np.isfinite(scores).all() else None,
        "us_per_cap": round(1e6 * taken / caps),
        "times_fit_ellipse": round(taken / plain, 1),
    }


def _errors(image: Truth, found: Sequence[Reconstruction]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """CDR in percent (m,), centre errors in standard deviations clipped at 5 (m, 2), visible shares (m,)."""
    known = np.array([each.centre is not None for each in found]) & image.counts
    nowhere = (np.nan, np.nan)
    off = np.array([each.centre or nowhere for each in found])[known] - image.centres[known]
    sd = np.array([each.centre_sd or nowhere for each in found])[known]
    cdr = 100 * np.abs(off / (image.width, image.height)).sum(axis=1)
    return cdr, np.clip(off / sd, -5, 5), image.visible[known]


def _plain(caps: Sequence[Silhouette]) -> float:
    """Seconds of the best of three runs of OpenCV alone."""

    def fit() -> None:
        for cap in caps:
            contours, _ = cv2.findContours(cap.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
            longest = max(contours, key=len, default=None)
            if longest is not None and len(longest) >= 5:
                cv2.fitEllipse(longest)

    return _seconds(fit)


def _seconds(work: Callable[[], object]) -> float:
    """The best of three, for others use this machine too."""
    taken = []
    for _ in range(3):
        start = time.perf_counter()
        work()
        taken.append(time.perf_counter() - start)
    return min(taken)
