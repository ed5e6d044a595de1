import numpy as np
import pytest

from fairyring.model.contour.classify import (
    Defect,
    Limits,
    corners_of,
    defects_of,
    longest,
    sub_contours,
)
from fairyring.model.contour.silhouette import Silhouette, contours_of


def disc(radius: float = 40.0, bite: tuple[float, float, float] | None = None) -> Silhouette:
    """A disc of pixels around (60, 60); ``bite`` (x, y, r) is another disc lying in front of it."""
    y, x = np.mgrid[0:120, 0:120] + 0.5
    mask = np.hypot(x - 60, y - 60) <= radius
    if bite is not None:
        mask &= np.hypot(x - bite[0], y - bite[1]) > bite[2]
    return Silhouette(mask.astype(np.uint8), 0, 0)


def test_a_disc_has_no_defects():
    contour = contours_of(disc())[0]
    assert all(Limits().ignore(d, length=len(contour), area=5026) for d in defects_of(contour))


def test_a_bite_is_one_defect_whose_ends_are_where_the_two_rims_cross():
    contour = contours_of(disc(bite=(100, 60, 30)))[0]
    kept = [d for d in defects_of(contour) if not Limits().ignore(d, length=len(contour), area=4000)]
    assert len(kept) == 1
    # The circles of radius 40 at x 60 and 30 at x 100 cross at x = 88.75, 27.81 above and below y = 60.
    ends = sorted(tuple(contour[i]) for i in corners_of(kept))
    assert ends[0] == pytest.approx((88.75, 60 - 27.81), abs=1.5)
    assert ends[1] == pytest.approx((88.75, 60 + 27.81), abs=1.5)
    assert kept[0].depth == pytest.approx(88.75 - 70, abs=1.5)
    assert kept[0].chord == pytest.approx(2 * 27.81, abs=2)


def test_the_shallow_limit_grows_with_the_cap():
    shallow = Defect(start=0, end=9, chord=9, depth=3)
    assert not Limits().ignore(shallow, length=100, area=np.pi * 20**2)  # 5 % of 40 px is 2 px
    assert Limits().ignore(shallow, length=400, area=np.pi * 40**2)  # 5 % of 80 px is 4 px
    assert not Limits().ignore(shallow, length=20, area=np.pi)  # never below 2 px


@pytest.mark.parametrize(
    ("length", "chord", "depth", "ignored"),
    [
        (89, 46, 10, False),
        (90, 46, 10, True),
        (179, 69, 30, False),
        (180, 69, 30, True),
        (400, 89, 40, False),
    ],
)
def test_the_printed_limits_are_those_of_section_5_1(length: int, chord: float, depth: float, ignored: bool):
    defect = Defect(start=0, end=5, chord=chord, depth=depth)
    assert Limits(kind="printed").ignore(defect, length=length, area=1000) is ignored


def test_sub_contours_wrap_round_and_share_their_corners():
    contour = np.column_stack([np.arange(10.0), np.zeros(10)])
    pieces = sub_contours(contour, [3, 5])
    assert [piece[:, 0].tolist() for piece in pieces] == [[3, 4, 5], [5, 6, 7, 8, 9, 0, 1, 2, 3]]
    assert longest(pieces) is pieces[1]


def test_a_contour_without_corners_is_one_piece():
    contour = np.zeros((4, 2))
    assert sub_contours(contour, []) == [contour]


def test_a_contour_that_touches_itself_is_no_trouble():
    mask = np.zeros((30, 30), np.uint8)
    mask[5:25, 15] = 1
    mask[5:10, 5:25] = 1
    mask[20:25, 8:20] = 1
    assert defects_of(contours_of(Silhouette(mask, 0, 0))[0])
