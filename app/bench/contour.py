"""Measures the contour methods: error of their centres, the deviation they state, and their time.

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
from fairyring.model.contour.coco import silhouettes_of
from fairyring.model.contour.methods import DEFAULT_METHOD, METHODS
from fairyring.model.contour.reconstruct import reconstruct_silhouettes
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.json_files import read_json
from fairyring.model.scene.clusters import Recipe, make_cluster

SEED = 70_000
HEAVY = 0.6
"""A cap with less of its area in sight counts as heavily hidden."""
PARTLY = 0.9
"""One with more than that and less than this, as partly hidden."""

RESAMPLES = 2000
"""Bootstrap resamples, which say how far a difference between two methods may be chance."""


@dataclass(frozen=True, slots=True)
class Truth:
    """The masks of an image's caps, with their true centres (n, 2) and visible shares (n,)."""

    name: str
    caps: list[Silhouette]
    centres: np.ndarray
    visible: np.ndarray
    counts: np.ndarray
    """(n,), whether each cap counts; the others are context alone."""
    doubtful: np.ndarray
    """(n,), whether a careful person could disagree about each cap."""
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Counted:
    """The m caps of all images that count."""

    image: np.ndarray
    """(m,), names of the images."""
    visible: np.ndarray
    doubtful: np.ndarray


Choice = Callable[[Counted], np.ndarray]
"""Chooses the caps that a row is about, (m,)."""
CERTAIN: dict[str, Choice] = {"without doubtful caps": lambda caps: ~caps.doubtful}
BY_COVERAGE: dict[str, Choice] = {
    **CERTAIN,
    "visible < 60 %": lambda caps: ~caps.doubtful & (caps.visible < HEAVY),
    "visible 60–90 %": lambda caps: ~caps.doubtful & (caps.visible >= HEAVY) & (caps.visible < PARTLY),
    "visible ≥ 90 %": lambda caps: ~caps.doubtful & (caps.visible >= PARTLY),
    "doubtful": lambda caps: caps.doubtful,
}


def contour_rows(*, quick: bool = False, real: Path | None = None) -> list[Row]:
    """One row a set of masks and method.

    Also of ``real``, a COCO file of checked photos or its folder, there by how much of the caps is in sight
    and photo by photo.
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
    """The rows of a COCO document of checked caps: of the certain ones, by coverage and photo, of the rest.

    Its caps hold ``center``, and may hold ``visible_fraction`` (else 1), ``doubt`` and ``ignore``.
    """
    images = _checked(document)
    photos = {image.name: _certain_of(image.name) for image in images} if len(images) > 1 else {}
    return _rows(images, BY_COVERAGE | photos)


def _certain_of(name: str) -> Choice:
    return lambda caps: ~caps.doubtful & (caps.image == name)


def _made(seed: int, noise: float) -> Truth:
    cluster = make_cluster(seed=seed, recipe=Recipe(noise=noise))
    return Truth(
        name=f"cluster {seed}",
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
                name=str(image["file_name"]),
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
    caps = Counted(
        image=np.concatenate([np.repeat(image.name, image.counts.sum()) for image in images]),
        visible=np.concatenate([image.visible[image.counts] for image in images]),
        doubtful=np.concatenate([image.doubtful[image.counts] for image in images]),
    )
    return [
        {
            "masks": masks,
            "method": method,
            **_figures(errors, chosen, caps.visible),
            **_over(errors.cdr[chosen], measured[DEFAULT_METHOD].cdr[chosen]),
            "us_per_cap": round(1e6 * errors.seconds / errors.caps),
            "times_fit_ellipse": round(errors.seconds / plain, 1),
        }
        for masks, choice in choices.items()
        if (chosen := choice(caps)).any()
        for method, errors in measured.items()
    ]


@dataclass(frozen=True, slots=True)
class Errors:
    """Errors of the m caps of all images that count; NaN where a method gives no centre."""

    cdr: np.ndarray
    """(m,), percent."""
    scores: np.ndarray
    """(m, 2), centre errors in standard deviations, clipped at 5."""
    seconds: float
    """Seconds that the method took for all caps of the images."""
    caps: int
    """How many caps that were."""


def _measure(method: str, images: Sequence[Truth]) -> Errors:
    def fit(image: Truth) -> list[Reconstruction]:
        return reconstruct_silhouettes(image.caps, width=image.width, height=image.height, method=method)

    errors = [_errors(image, fit(image)) for image in images]
    cdr, scores = (np.concatenate(part) for part in zip(*errors, strict=True))
    seconds = sum(_seconds(lambda image=image: fit(image)) for image in images)
    return Errors(cdr, scores, seconds, sum(len(image.caps) for image in images))


def _figures(errors: Errors, chosen: np.ndarray, visible: np.ndarray) -> Row:
    """Figures of the chosen caps, of those that have a centre."""
    known = chosen & np.isfinite(errors.cdr)
    cdr, scores = errors.cdr[known], errors.scores[known]
    heavy = cdr[visible[known] < HEAVY]
    if len(cdr) == 0:
        return {"caps": 0}
    return {
        "caps": len(cdr),
        "cdr_mean": round(float(cdr.mean()), 4),
        "cdr_median": round(float(np.median(cdr)), 4),
        "cdr_p95": round(float(np.percentile(cdr, 95)), 3),
        "cdr_heavily_hidden": round(float(heavy.mean()), 3) if len(heavy) else None,
        "rms_z": round(float(np.sqrt(np.mean(scores**2))), 2) if np.isfinite(scores).all() else None,
    }


def _over(cdr: np.ndarray, best: np.ndarray) -> Row:
    """How much larger errors (k,) are in the mean than the default method's on the same caps.

    With the interval that holds 95 % of that mean when the caps are drawn anew, each time with both errors.
    """
    more = (cdr - best)[np.isfinite(cdr - best)]
    if not more.any():
        return {"over_map": None, "over_map_95": None}
    draws = np.random.default_rng(SEED).integers(len(more), size=(RESAMPLES, len(more)))
    low, high = np.percentile(more[draws].mean(axis=1), (2.5, 97.5))
    return {"over_map": round(float(more.mean()), 4), "over_map_95": f"{low:.3f} to {high:.3f}"}


def _errors(image: Truth, found: Sequence[Reconstruction]) -> tuple[np.ndarray, np.ndarray]:
    """The first two fields of `Errors`, of the caps that count."""
    nowhere = (np.nan, np.nan)
    off = np.array([each.fit.centre or nowhere for each in found])[image.counts] - image.centres[image.counts]
    sd = np.array([each.fit.centre_sd or nowhere for each in found])[image.counts]
    return 100 * np.abs(off / (image.width, image.height)).sum(axis=1), np.clip(off / sd, -5, 5)


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
    """Processor time of the fastest of three calls, as others use this machine too."""
    taken = []
    for _ in range(3):
        start = time.process_time()
        work()
        taken.append(time.process_time() - start)
    return min(taken)
