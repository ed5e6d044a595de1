"""COCO's average precision and recall of masks, by faster-coco-eval. All caps are one class."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import faster_coco_eval
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.matching import mask_of
from fairyring.model.evaluate.pages import Page
from fairyring.model.geometry.raster import area_of_rle

MAX_DETECTIONS = (1, 10, 300)
"""How many best predictions of an image count; AP and AR use the last. A bed holds more than COCO's 100.

It grows where an image has more true caps: else they could not all be found.
"""
CATEGORY = 1
AT_ONCE = 20
"""How many images are matched at once."""


class AveragePrecision(Struct, frozen=True, kw_only=True):
    """Fractions of 1; None where the truth has no cap to find."""

    ap: float | None
    """AP, the mean over IoU .5, .55, … .95."""
    ap50: float | None
    ap75: float | None
    ar: float | None
    """Recall of all counted predictions, mean over the same IoUs."""
    ap_by_size: tuple[float | None, ...]
    """AP of COCO's small, medium and large visible areas; empty where not asked for."""


@dataclass(frozen=True)
class Matches:
    """Images whose predictions were matched with their true caps, for figures of any of these images."""

    pages: Sequence[Page]
    of_areas: list[list[Any]]
    """What faster-coco-eval made of it, by COCO's areas (all, small, medium, large), then by image."""
    params: Any
    """The settings with which it did."""


def average_precision(pages: Sequence[Page], *, by_size: bool = False) -> AveragePrecision:
    """AP and AR of the predictions in these images. Ignored caps go in as crowds, sized by their masks."""
    return precision_of(matches_of(pages), range(len(pages)), by_size=by_size)


def matches_of(pages: Sequence[Page]) -> Matches:
    """Matches a few images at a time: COCO's form of a cap takes ten times the memory of ours."""
    most = most_detections(pages)
    params: Any = _params(most)
    of_areas: list[list[Any]] = [[] for _ in params.areaRng]
    for start in range(0, len(pages), AT_ONCE):
        some = pages[start : start + AT_ONCE]
        # One category; within it areas, and within these images.
        found = _evaluated(some, most)
        for area, of_area in enumerate(of_areas):
            of_area.extend(found[area * len(some) : (area + 1) * len(some)])
    return Matches(pages=pages, of_areas=of_areas, params=params)


def precision_of(matches: Matches, chosen: Sequence[int], *, by_size: bool = False) -> AveragePrecision:
    """AP and AR of the images at these places, as if there were no others."""
    params = copy.copy(matches.params)
    params.imgIds = list(range(1, len(chosen) + 1))
    params.maxDets = [*MAX_DETECTIONS[:2], most_detections([matches.pages[place] for place in chosen])]
    areas = len(matches.of_areas) if by_size else 1
    params.areaRng, params.areaRngLbl = params.areaRng[:areas], params.areaRngLbl[:areas]
    evaluation: Any = faster_coco_eval.COCOeval_faster(iouType="segm", separate_eval=True)
    evaluation._paramsEval = params
    evaluation._evalImgs_cpp = [found[place] for found in matches.of_areas[:areas] for place in chosen]
    evaluation.accumulate()
    # IoUs, recalls, classes, areas, detections; and the same without recalls. -1 where there is no truth.
    precision: NDArray[np.float64] = evaluation.eval["precision"][:, :, 0, :, -1]
    recall: NDArray[np.float64] = evaluation.eval["recall"][:, 0, :, -1]
    return AveragePrecision(
        ap=_mean(precision[:, :, 0]),
        ap50=_mean(precision[0, :, 0]),
        ap75=_mean(precision[5, :, 0]),
        ar=_mean(recall[:, 0]),
        ap_by_size=tuple(_mean(precision[:, :, area]) for area in range(1, precision.shape[2])),
    )


def _params(most: int) -> Any:
    params: Any = faster_coco_eval.COCOeval_faster(iouType="segm").params
    params.catIds = [CATEGORY]
    params.maxDets = [*MAX_DETECTIONS[:2], most]
    return params


def _evaluated(pages: Sequence[Page], most: int) -> list[Any]:
    document, results = coco_of_pages(pages)
    evaluation: Any = faster_coco_eval.COCOeval_faster(
        faster_coco_eval.COCO(document),
        faster_coco_eval.COCO({**document, "annotations": results}),
        iouType="segm",
        separate_eval=True,
    )
    evaluation.params.maxDets = _params(most).maxDets
    evaluation.evaluate()
    return evaluation._evalImgs_cpp


def most_detections(pages: Sequence[Page]) -> int:
    """How many best predictions of an image count in AP and AR."""
    caps = max((sum(not cap.ignored for cap in page.truths) for page in pages), default=0)
    return max(MAX_DETECTIONS[-1], caps)


def coco_of_pages(pages: Sequence[Page]) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """A plain COCO document of the truth and the annotations of the predictions, numbered from 1."""
    document = {
        "images": [
            {"id": number, "file_name": page.file_name, "width": page.width, "height": page.height}
            for number, page in enumerate(pages, start=1)
        ],
        "annotations": list(_annotations([page.truths for page in pages], predicted=False)),
        "categories": [{"id": CATEGORY, "name": DEFAULT_CATEGORY}],
    }
    return document, list(_annotations([page.predictions for page in pages], predicted=True))


def _annotations(images: list[list[CapRecord]], *, predicted: bool) -> Iterator[dict[str, Any]]:
    number = 0
    for image, caps in enumerate(images, start=1):
        for cap in caps:
            # COCO's matching takes the id 0 for "none".
            number += 1
            rle = mask_of(cap)
            yield {
                "id": number,
                "image_id": image,
                "category_id": CATEGORY,
                "segmentation": rle,
                "area": area_of_rle(rle),
                "iscrowd": int(cap.ignored and not predicted),
                **({"score": cap.score} if predicted else {}),
            }


def _mean(figures: NDArray[np.float64]) -> float | None:
    known = figures[figures > -1]
    return float(known.mean()) if known.size else None
