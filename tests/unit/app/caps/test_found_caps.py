"""The network's cap where somebody points, as a worker finds it."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from fairyring.app.caps.found_caps import Asked, cap_found, near
from fairyring.app.caps.image_caps import caps_of
from fairyring.model.predict.shipped import SHIPPED
from fairyring.storage.records import Annotation, Cap, Image, ImageContents


def square(x: float, y: float, side: float = 20.0) -> list[list[float]]:
    return [[x, y, x + side, y, x + side, y + side, x, y + side]]


def test_only_caps_near_to_what_is_pointed_at_may_hide_any_of_it() -> None:
    close, far = square(100, 100), square(900, 100)
    image = Image(id=1, file_name="a.jpg", path="a.jpg", width=1000, height=300, sha256="")
    drawn = [
        Annotation(uid=uid, image=1, revision=1, cap=Cap(visible=v)) for uid, v in (("a", close), ("b", far))
    ]
    caps = caps_of(ImageContents(image=image, annotations=drawn, predictions=[], run=None))
    assert near(caps, [(150.0, 150.0)], besides=None) == [close]
    assert near(caps, [(150.0, 150.0), (880.0, 90.0)], besides=None) == [close, far]
    assert near(caps, [(150.0, 150.0), (880.0, 90.0)], besides="a") == [far], "a cap hides nothing of itself"
    assert near(caps, [], besides=None) == []


def test_a_disc_is_found_at_a_point_and_in_a_box_less_what_lies_in_front(tmp_path: Path) -> None:
    photo = np.full((256, 320, 3), 40, np.uint8)
    cv2.circle(photo, (150, 120), 40, (215, 222, 225), -1, cv2.LINE_AA)
    path = tmp_path / "bed.png"
    cv2.imwrite(str(path), cv2.GaussianBlur(photo, (5, 5), 0))
    asked = Asked(photo=path, weights=SHIPPED)
    assert cap_found(asked) is None, "it only looks"
    at = cap_found(Asked(photo=path, weights=SHIPPED, points=[(150.0, 120.0)], wanted=[True]))
    within = cap_found(Asked(photo=path, weights=SHIPPED, box=(105.0, 75.0, 195.0, 165.0)))
    for found in (at, within):
        assert found is not None
        xs, ys = np.reshape(found[1][0], (-1, 2)).T
        assert np.abs(np.hypot(xs - 150.5, ys - 120.5) - 40).mean() < 2.5
    front = [[[150.0, 60.0, 220.0, 60.0, 220.0, 180.0, 150.0, 180.0]]]
    cut = cap_found(Asked(photo=path, weights=SHIPPED, points=[(130.0, 120.0)], wanted=[True], front=front))
    assert cut is not None
    assert max(cut[1][0][::2]) < 153
