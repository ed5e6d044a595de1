"""Clicks and boxes on a rendered bed, seen by the shipped weights."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import torch

from fairyring.model import photo
from fairyring.model.geometry.boxes import box_of_outline
from fairyring.model.geometry.raster import covered_matrix, iou_matrix, mask_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import Outline, area_of_outline
from fairyring.model.json_files import read_json
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection, Seen
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.scene.dataset import DOCUMENT, write_beds
from tests.support.small_beds import small

Point = tuple[float, float]


@dataclass
class Bed:
    """A bed as it was seen, and the outlines of its larger caps."""

    predictor: Predictor
    seen: Seen
    caps: list[Outline]

    def iou(self, outline: Outline, found: Detection | None) -> float:
        """IoU of an outline with what was found; 0 for nothing."""
        return 0.0 if found is None else float(iou_matrix([self.rle(outline)], [found.rle])[0, 0])

    def rle(self, outline: Outline) -> dict[str, Any]:
        """The outline's pixels."""
        return rle_of_outline(outline, height=self.seen.height, width=self.seen.width)

    def middle(self, outline: Outline) -> Point:
        """The middle of the pixel furthest inside."""
        inside = cv2.distanceTransform(np.pad(mask_of_rle(self.rle(outline)), 1), cv2.DIST_L2, 5)
        row, column = np.unravel_index(int(np.asarray(inside).argmax()), np.shape(inside))
        return float(column) - 0.5, float(row) - 0.5

    def holds(self, found: Detection, point: Point) -> bool:
        """Whether a point lies on what was found."""
        return bool(mask_of_rle(found.rle)[int(point[1]), int(point[0])])


@pytest.fixture(scope="module")
def bed(tmp_path_factory: pytest.TempPathFactory) -> Bed:
    out: Path = tmp_path_factory.mktemp("bed")
    write_beds(out, small(), count=1, seed=11)
    document = read_json(out / DOCUMENT)
    (entry,) = document["images"]
    pixels = photo.read(out / "images" / entry["file_name"])[:, :, ::-1].copy()
    predictor = Predictor(load_weights(SHIPPED).network, device=torch.device("cpu"))
    outlines = [cap["segmentation"] for cap in document["annotations"]]
    caps = [outline for outline in outlines if area_of_outline(outline) > 600]
    assert len(caps) >= 5
    return Bed(predictor=predictor, seen=predictor.see(pixels), caps=caps)


def test_a_click_inside_a_cap_gives_that_cap(bed: Bed) -> None:
    middles = [bed.middle(cap) for cap in bed.caps]
    found = [bed.predictor.at(bed.seen, [middle]) for middle in middles]
    assert all(one is None or bed.holds(one, middle) for one, middle in zip(found, middles, strict=True))
    likeness = [bed.iou(cap, one) for cap, one in zip(bed.caps, found, strict=True)]
    assert np.mean(np.array(likeness) >= 0.5) >= 0.8


def test_a_box_around_a_cap_gives_that_cap(bed: Bed) -> None:
    likeness = [bed.iou(cap, bed.predictor.within(bed.seen, box_of_outline(cap))) for cap in bed.caps]
    assert np.mean(np.array(likeness) >= 0.5) >= 0.8


def test_a_further_click_takes_away(bed: Bed) -> None:
    for cap in bed.caps:
        click = bed.middle(cap)
        first = bed.predictor.at(bed.seen, [click])
        if first is None or bed.iou(cap, first) < 0.5:
            continue
        left = box_of_outline(first.outline)[0]
        taken = ((click[0] + left) / 2, click[1])
        second = bed.predictor.at(bed.seen, [click, taken], [True, False])
        assert second is not None
        assert not bed.holds(second, taken)
        assert bed.holds(second, click)


def test_a_further_click_adds_what_is_seen_there(bed: Bed) -> None:
    certain = [cap for cap in bed.caps if bed.iou(cap, bed.predictor.at(bed.seen, [bed.middle(cap)])) > 0.7]
    first, second = certain[:2]
    both = bed.predictor.at(bed.seen, [bed.middle(first), bed.middle(second)], [True, True])
    assert both is not None
    # A second part is left out where it is less than half of the larger, as everywhere.
    assert bed.holds(both, bed.middle(first)) or bed.holds(both, bed.middle(second))
    alone = bed.predictor.at(bed.seen, [bed.middle(first)])
    assert alone is not None
    assert np.count_nonzero(mask_of_rle(both.rle)) >= np.count_nonzero(mask_of_rle(alone.rle))


def test_a_cap_is_cut_where_others_lie_in_front(bed: Bed) -> None:
    cap = max(bed.caps, key=area_of_outline)
    x, y = bed.middle(cap)
    left, top, right, bottom = box_of_outline(cap)
    in_front = [[x + 5, top - 5, right + 5, top - 5, right + 5, bottom + 5, x + 5, bottom + 5]]
    found = bed.predictor.at(bed.seen, [(x, y)], front=[in_front])
    assert found is not None
    assert covered_matrix([found.rle], [bed.rle(in_front)])[0, 0] < 0.05
    # Whoever is clicked on is not in front.
    around = [[left - 5, top - 5, right + 5, top - 5, right + 5, bottom + 5, left - 5, bottom + 5]]
    whole = bed.predictor.at(bed.seen, [(x, y)], front=[around])
    assert whole is not None
    assert whole.outline == getattr(bed.predictor.at(bed.seen, [(x, y)]), "outline", None)


def test_what_others_leave_far_from_the_click_is_no_cap(bed: Bed) -> None:
    cap = max(bed.caps, key=area_of_outline)
    left, top, right, bottom = box_of_outline(cap)
    click = (left + 2, bed.middle(cap)[1])
    alone = bed.predictor.at(bed.seen, [click])
    assert alone is not None
    assert bed.iou(cap, alone) > 0.5
    inner, outer = left + 2.5, right - 10
    between = [[inner, top - 5, outer, top - 5, outer, bottom + 5, inner, bottom + 5]]
    assert bed.predictor.at(bed.seen, [click], front=[between]) is None


def test_clicks_must_be_labelled_and_begin_on_the_cap(bed: Bed) -> None:
    with pytest.raises(ValueError, match="label"):
        bed.predictor.at(bed.seen, [(10, 10), (20, 20)], [True])
    with pytest.raises(ValueError, match="first"):
        bed.predictor.at(bed.seen, [(10, 10)], [False])
    with pytest.raises(ValueError, match="left"):
        bed.predictor.within(bed.seen, (20, 10, 10, 30))
