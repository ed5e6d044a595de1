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
    ],
    ids=str,
)
def test_everything_else_stays(keys):
    assert without_geometry(keys) == keys
