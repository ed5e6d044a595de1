import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.app.bench.worst import COLUMNS, PANEL, draw_worst
from fairyring.model.errors import FileError
from fairyring.model.geometry.shapes import Circle, polygon_of_shape

TRUTH = (0, 255, 255)
"""RGB."""


@pytest.fixture
def beds(tmp_path: Path) -> Path:
    """Three discs whose checked centres are 0, 3 and 6 px off, one of them doubtful, on a grey photo."""
    (tmp_path / "images").mkdir()
    cv2.imwrite(str(tmp_path / "images" / "bed.png"), np.full((120, 320, 3), 90, np.uint8))
    annotations = [
        {
            "id": 11 + place,
            "image_id": 1,
            "segmentation": [polygon_of_shape(Circle(cx=60.0 + 90 * place, cy=60, r=25))],
            "center": [60 + 90 * place + 3 * place, 60],
            "circle": [60 + 90 * place + 3 * place, 60, 25],
            "doubt": place == 2,
        }
        for place in range(3)
    ]
    document = {
        "images": [{"id": 1, "file_name": "bed.png", "width": 320, "height": 120}],
        "annotations": annotations,
    }
    (tmp_path / "checked.json").write_text(json.dumps(document))
    return tmp_path


def test_the_caps_furthest_off_are_drawn_first_and_doubtful_ones_not_at_all(beds: Path):
    draw_worst(beds, beds / "worst", methods=["map", "enclosing"])
    assert sorted(path.name for path in (beds / "worst").iterdir()) == [
        "enclosing-01-bed-12.png",
        "enclosing-02-bed-11.png",
        "enclosing-worst.png",
        "map-01-bed-12.png",
        "map-02-bed-11.png",
        "map-worst.png",
    ]
    sheet = cv2.imread(str(beds / "worst" / "map-worst.png"))
    assert sheet is not None
    assert sheet.shape[1] == COLUMNS * PANEL


def test_the_true_centre_lies_in_the_middle_of_its_picture(beds: Path):
    draw_worst(beds, beds / "worst", methods=["map"])
    picture = cv2.imread(str(beds / "worst" / "map-01-bed-12.png"))
    assert picture is not None
    middle = picture[PANEL // 2 - 2 : PANEL // 2 + 2, PANEL // 2 - 2 : PANEL // 2 + 2]
    assert np.abs(middle.mean(axis=(0, 1))[::-1] - TRUTH).max() < 20
    # 3 px to the left, 400 / 100 times enlarged, the most probable centre.
    found = picture[PANEL // 2 - 2 : PANEL // 2 + 2, PANEL // 2 - 14 : PANEL // 2 - 10]
    assert np.abs(found.mean(axis=(0, 1))[::-1] - (255, 0, 255)).max() < 60


def test_a_folder_that_cannot_be_made_is_named(beds: Path):
    (beds / "file").write_text("")
    with pytest.raises(FileError, match="file"):
        draw_worst(beds, beds / "file" / "worst", methods=["map"])
