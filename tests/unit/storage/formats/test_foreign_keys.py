"""Which keys of other programs outlive an edit."""

import pytest

from fairyring.storage.formats.foreign_keys import without_geometry


@pytest.mark.parametrize(
    "keys",
    [
        {"i_bbox": [1, 2, 3, 4]},
        {"amodalBbox": None},
        {"a_area": 12.5},
        {"visible_mask": {"size": [4, 4], "counts": "32;"}},
        {"rotation": 30},
        {"center_sd": [0.1, 0.1]},
        {"source": "drawn by hand"},
        {"where": [1, 2, 3, 4]},
        {"where": [[1, 2], [3, 4]]},
        {"where": [[[1, 2, 3, 4]]]},
        {"where": [{"x": 1, "y": 2}]},
        {"attributes": {"occluded": True}},
        {"aspect_ratio": 1.04},
        {"orientation": 12},
        {"measures": {"solidity": 0.97, "perimeter": 81.2, "convexity": 0.9}},
        {"keypoints": [12, 14, 2], "num_keypoints": 1},
        {"rle": {"size": [4, 4], "counts": "32;"}},
        {"stability_score": 0.93, "predicted_iou": 0.88},
        {"meanIntensity": 121.5, "length_mm": 31},
        {"cx": 20.0, "xMin": 3, "major": 11},
        {"feret_max": 33.1, "hu_1": 0.16},
        {"verified": True},
        {"reviewedBy": "Ada", "updated_at": "2024-05-01"},
        {"as_text": "POLYGON ((0 0, 10 0, 10 10, 0 0))", "drawn": "M0 0 L10 0 L10 10 Z"},
        {"inline": "data:image/png;base64,iVBORw0KGgo", "thumb_png": "iVBORw0KGgoAAAA"},
        {"geojson": {"type": "Polygon", "coordinates": [[[0, 0], [10, 0], [0, 10]]]}},
        {"blur": 3.2, "rgb": [120, 100, 80], "occ": 0.2, "seg_counts": "32;"},
    ],
    ids=str,
)
def test_what_tells_of_geometry_by_name_or_by_content_goes(keys):
    assert without_geometry(keys | {"note": "kept"}) == {"note": "kept"}


@pytest.mark.parametrize(
    "keys",
    [
        {"tags": ["a", "b"]},
        {"tags": [1, 2, 3]},
        {"attributes": {"variety": "brown", "grade": 2}},
        {"empty": {}},
        {"answers": [True, False, True, True]},
        {"group_id": 7},
        {"track": None},
        {"people": [{"name": "Ada"}]},
        {"position": "shelf 2", "roundness": "oval", "edge": "curled"},
        {"weight_g": 12.5, "age_days": 4, "price": 0.4},
        {"created_by": "Ada", "text": "spotted", "xylem": 3},
        {"quality": "A", "colour": "brown"},
        {"note": "Multipolygon was hard to draw", "said": "M. 12 was here", "z_order": 3},
    ],
    ids=str,
)
def test_everything_else_stays(keys):
    assert without_geometry(keys) == keys
