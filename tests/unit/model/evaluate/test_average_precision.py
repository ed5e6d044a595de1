"""AP and AR against pycocotools, on the same documents."""

from __future__ import annotations

import contextlib
import copy
import io
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval

from fairyring.model.evaluate.average_precision import (
    AT_ONCE,
    average_precision,
    coco_of_pages,
    matches_of,
    precision_of,
)
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.masks import score_masks
from fairyring.model.evaluate.pages import Page
from fairyring.model.geometry.raster import rle_of_mask

SIDE = 160


def reference(pages: list[Page]) -> Any:
    document, results = coco_of_pages(pages)
    with contextlib.redirect_stdout(io.StringIO()):
        truth = COCO()
        truth.dataset = copy.deepcopy(document)
        truth.createIndex()
        evaluation = COCOeval(truth, truth.loadRes(copy.deepcopy(results)), "segm")
        evaluation.params.maxDets = [1, 10, 300]
        evaluation.evaluate()
        evaluation.accumulate()
    return evaluation


def mean(figures: np.ndarray) -> float | None:
    return float(figures[figures > -1].mean()) if (figures > -1).any() else None


def ellipse(x: float, y: float, a: float, b: float) -> dict[str, Any]:
    rows, columns = np.mgrid[:SIDE, :SIDE] + 0.5
    return rle_of_mask(((columns - x) / a) ** 2 + ((rows - y) / b) ** 2 < 1)


places = st.tuples(*[st.floats(0, SIDE)] * 2, *[st.floats(4, 60)] * 2)
shifts = st.tuples(*[st.floats(-4, 4)] * 4)


@st.composite
def photos(draw: Any) -> Page:
    """Ellipses, some of them ignored; predictions near some of them and elsewhere, some of equal score."""
    drawn = draw(st.lists(places, max_size=6))
    near = [tuple(np.add(place, draw(shifts))) for place in drawn for _ in range(draw(st.integers(0, 2)))]
    scores = st.one_of(st.sampled_from([0.3, 0.5, 0.9]), st.floats(0, 1))
    return Page(
        file_name="photo.png",
        width=SIDE,
        height=SIDE,
        truths=[CapRecord(rle=ellipse(*p), ignored=draw(st.integers(0, 4)) == 0) for p in drawn],
        predictions=[
            CapRecord(rle=ellipse(x, y, max(a, 1), max(b, 1)), score=draw(scores))
            for x, y, a, b in [*near, *draw(st.lists(places, max_size=2))]
        ],
    )


# pycocotools needs a prediction to begin with.
beds = st.lists(photos(), min_size=1, max_size=3).filter(lambda pages: any(p.predictions for p in pages))


@given(pages=beds)
@settings(max_examples=60)
def test_average_precision_and_recall_are_pycocotools(pages: list[Page]) -> None:
    found, expected = average_precision(pages, by_size=True), reference(pages).eval

    precision, recall = expected["precision"][:, :, 0, :, 2], expected["recall"][:, 0, :, 2]
    assert found.ap == pytest.approx(mean(precision[..., 0]), abs=1e-12)
    assert found.ap50 == pytest.approx(mean(precision[0, :, 0]), abs=1e-12)
    assert found.ap75 == pytest.approx(mean(precision[5, :, 0]), abs=1e-12)
    assert found.ar == pytest.approx(mean(recall[:, 0]), abs=1e-12)
    by_size = [mean(precision[..., area]) for area in (1, 2, 3)]
    assert found.ap_by_size == tuple(
        size if size is None else pytest.approx(size, abs=1e-12) for size in by_size
    )


@given(pages=beds)
@settings(max_examples=60)
def test_the_caps_that_count_as_found_are_those_pycocotools_matches(pages: list[Page]) -> None:
    of_photos = [image for image in reference(pages).evalImgs[: len(pages)] if image]
    # Rows: IoU .5, .55, …; 0 where there is no partner.
    scores = np.concatenate([image["dtScores"] for image in of_photos] or [[]])
    taken = [(image["dtMatches"][0] > 0) & (image["dtIgnore"][0] == 0) for image in of_photos]
    matched = np.concatenate(taken or [[]]).astype(bool)

    counts = score_masks(pages).counts

    assert counts.matched == int((matched & (scores >= 0.5)).sum())


def test_more_predictions_than_coco_s_hundred_count() -> None:
    squares = []
    for nth in range(150):
        mask = np.zeros((SIDE, SIDE), np.uint8)
        mask[nth // 15 * 10 : nth // 15 * 10 + 8, nth % 15 * 10 : nth % 15 * 10 + 8] = 1
        squares.append(CapRecord(rle=rle_of_mask(mask), score=0.9 - nth / 1000))
    page = Page(file_name="bed.png", width=SIDE, height=SIDE, truths=squares, predictions=squares)

    found = average_precision([page])

    assert (found.ap, found.ar) == (1.0, 1.0)
    assert found.ap_by_size == ()


def test_a_bed_of_more_caps_than_count_can_be_found_whole() -> None:
    caps = []
    for nth in range(600):
        mask = np.zeros((SIDE, SIDE), np.uint8)
        row, column = divmod(nth, 26)
        mask[6 * row : 6 * row + 5, 6 * column : 6 * column + 5] = 1
        caps.append(CapRecord(rle=rle_of_mask(mask), score=0.9))
    whole = Page(file_name="a.png", width=SIDE, height=SIDE, truths=caps, predictions=caps)
    found = average_precision([whole])
    assert (found.ap, found.ap50, found.ar) == (1, 1, 1)


def test_of_many_images_and_of_some_of_them_it_is_pycocotools() -> None:
    random = np.random.default_rng(0)
    pages = []
    for nth in range(2 * AT_ONCE + 5):
        truths = [CapRecord(rle=ellipse(*random.uniform(20, 140, 2), 15, 12)) for _ in range(nth % 4)]
        said = [CapRecord(rle=ellipse(*random.uniform(20, 140, 2), 15, 12), score=random.uniform(0, 1))]
        pages.append(
            Page(
                file_name=f"{nth}.png",
                width=SIDE,
                height=SIDE,
                truths=truths,
                predictions=[*said, *(CapRecord(rle=cap.rle, score=random.uniform(0, 1)) for cap in truths)],
            )
        )
    matches = matches_of(pages)
    some = [3, 4, 21, 44]
    for chosen in (range(len(pages)), some):
        expected = mean(reference([pages[place] for place in chosen]).eval["precision"][:, :, 0, 0, 2])
        assert precision_of(matches, chosen).ap == pytest.approx(expected, abs=1e-12)
