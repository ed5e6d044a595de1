"""How far each contour method's centres are from the truth, how well it knows that, and how long it takes.

Clusters are made by the recipe of ``model.scene.clusters`` with other seeds than anything was tuned on. The
time is compared with what anybody would write: ``findContours`` and ``fitEllipse`` on the same cropped masks.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from fairyring.app.bench.timing import Row
from fairyring.app.commands.files import read_json
from fairyring.model.contour.coco import silhouettes_of
from fairyring.model.contour.methods import METHODS
from fairyring.model.contour.reconstruct import Reconstruction, reconstruct_silhouettes
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.scene.clusters import Recipe, make_cluster

SEED = 70_000
HEAVY = 0.6
"""A cap with less of its area in sight counts as heavily hidden."""
PARTLY = 0.9
"""One with more than that and less than this, as partly hidden."""

Choice = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Which caps a row is about, by the visible shares and the doubts of all (n,)."""
CERTAIN: dict[str, Choice] = {"without doubtful caps": lambda _visible, doubtful: ~doubtful}
BY_COVERAGE: dict[str, Choice] = {
    **CERTAIN,
    "visible < 60 %": lambda visible, doubtful: ~doubtful & (visible < HEAVY),
    "visible 60–90 %": lambda visible, doubtful: ~doubtful & (visible >= HEAVY) & (visible < PARTLY),
    "visible ≥ 90 %": lambda visible, doubtful: ~doubtful & (visible >= PARTLY),
    "doubtful": lambda _visible, doubtful: doubtful,
}


@dataclass(frozen=True, slots=True)
class Truth:
    """An image's masks with the true centres (n, 2) and the visible shares of the caps (n,)."""

    caps: list[Silhouette]
    centres: np.ndarray
    visible: np.ndarray
    counts: np.ndarray
    """(n,), which caps count; the others are context alone."""
    doubtful: np.ndarray
    """(n,), of which caps a careful person could think otherwise."""
    width: int
    height: int


def contour_rows(*, quick: bool = False, real: Path | None = None) -> list[Row]:
    """One row a set of masks and method.

    Also of ``real``, a COCO file of checked photos or its folder, there by how much of the caps is in sight.
    """
    count = 1 if quick else 20
    rows = []
    for noise in (0.0, 1.0, 2.0):
        images = [_made(SEED + index, noise) for index in range(count)]
        rows += _rows(images, {f"clusters, noisy by {noise:.0f} px": CERTAIN["without doubtful caps"]})
    if real is not None:
        checked = measured_by_coverage(read_json(real / "checked.json" if real.is_dir() else real))
        rows += [{**row, "masks": f"{real.name}, {row['masks']}"} for row in checked]
    return rows


def measured_by_coverage(document: dict[str, Any]) -> list[Row]:
    """The rows of a COCO document of checked caps: of all that are certain, by coverage, of the doubtful.

    Its caps hold ``center``, and may hold ``visible_fraction`` (else 1), ``doubt`` and ``ignore``.
    """
    return _rows(_checked(document), BY_COVERAGE)


def _made(seed: int, noise: float) -> Truth:
    cluster = make_cluster(seed=seed, recipe=Recipe(noise=noise))
    return Truth(
        caps=[Silhouette(cap.mask, cap.left, cap.top) for cap in cluster.caps],
        centres=np.array([(cap.whole.cx, cap.whole.cy) for cap in cluster.caps]),
        visible=np.array([cap.visible_fraction for cap in cluster.caps]),
        counts=np.ones(len(cluster.caps), np.bool_),
        doubtful=np.zeros(len(cluster.caps), np.bool_),
        width=cluster.width,
        height=cluster.height,
    )


def _checked(document: dict[str, Any]) -> list[Truth]:
    images = []
    for image in document["images"]:
        caps = [each for each in document["annotations"] if each["image_id"] == image["id"]]
        images.append(
            Truth(
                caps=silhouettes_of(caps, width=image["width"], height=image["height"]),
                centres=np.array([cap["center"] for cap in caps], np.float64),
                visible=np.array([cap.get("visible_fraction", 1.0) for cap in caps]),
                counts=np.array([not cap.get("ignore") for cap in caps], np.bool_),
                doubtful=np.array([bool(cap.get("doubt")) for cap in caps], np.bool_),
                width=image["width"],
                height=image["height"],
            )
        )
    return images


def _rows(images: Sequence[Truth], choices: dict[str, Choice]) -> list[Row]:
    plain = sum(_plain(image.caps) for image in images)
    measured = {method: _measure(method, images) for method in METHODS}
    return [
        row
        for masks, choice in choices.items()
        for method, errors in measured.items()
        if (row := _row(errors, choice, masks=masks, method=method, plain=plain)) is not None
    ]


@dataclass(frozen=True, slots=True)
class Errors:
    """Of the caps of all images for which a method gives a centre."""

    cdr: np.ndarray
    """(m,), percent."""
    scores: np.ndarray
    """(m, 2), centre errors in standard deviations, clipped at 5."""
    visible: np.ndarray
    doubtful: np.ndarray
    seconds: float
    """That the method took for all of the images' caps."""
    caps: int
    """How many those were."""


def _measure(method: str, images: Sequence[Truth]) -> Errors:
    def fit(image: Truth) -> list[Reconstruction]:
        return reconstruct_silhouettes(image.caps, width=image.width, height=image.height, method=method)

    errors = [_errors(image, fit(image)) for image in images]
    cdr, scores, visible, doubtful = (np.concatenate(part) for part in zip(*errors, strict=True))
    seconds = sum(_seconds(lambda image=image: fit(image)) for image in images)
    return Errors(cdr, scores, visible, doubtful, seconds, sum(len(image.caps) for image in images))


def _row(errors: Errors, choice: Choice, *, masks: str, method: str, plain: float) -> Row | None:
    """None where there is no such cap."""
    chosen = choice(errors.visible, errors.doubtful)
    if not chosen.any():
        return None
    cdr, scores = errors.cdr[chosen], errors.scores[chosen]
    heavy = cdr[errors.visible[chosen] < HEAVY]
    return {
        "masks": masks,
        "method": method,
        "caps": len(cdr),
        "cdr_mean": round(float(cdr.mean()), 4),
        "cdr_median": round(float(np.median(cdr)), 4),
        "cdr_p95": round(float(np.percentile(cdr, 95)), 3),
        "cdr_heavily_hidden": round(float(heavy.mean()), 3) if len(heavy) else None,
        "rms_z": round(float(np.sqrt(np.mean(scores**2))), 2) if np.isfinite(scores).all() else None,
        "us_per_cap": round(1e6 * errors.seconds / errors.caps),
        "times_fit_ellipse": round(errors.seconds / plain, 1),
    }


def _errors(image: Truth, found: Sequence[Reconstruction]) -> tuple[np.ndarray, ...]:
    """Of the caps that count and have a centre: as the first four fields of `Errors`."""
    known = np.array([each.centre is not None for each in found]) & image.counts
    nowhere = (np.nan, np.nan)
    off = np.array([each.centre or nowhere for each in found])[known] - image.centres[known]
    sd = np.array([each.centre_sd or nowhere for each in found])[known]
    cdr = 100 * np.abs(off / (image.width, image.height)).sum(axis=1)
    return cdr, np.clip(off / sd, -5, 5), image.visible[known], image.doubtful[known]


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
