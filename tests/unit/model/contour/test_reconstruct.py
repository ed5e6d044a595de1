import math

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.contour.circle import enclosing_circle
from fairyring.model.contour.methods import METHODS
from fairyring.model.contour.reconstruct import reconstruct, reconstruct_silhouettes
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, contours_of
from fairyring.model.geometry.shapes import Circle, Ellipse, diameter_of_shape, polygon_of_shape

SIZE = {"width": 400, "height": 300}


def outline(shape: Circle | Ellipse) -> list[list[float]]:
    return [polygon_of_shape(shape)]


def crescent(hidden: Circle, front: Circle) -> Silhouette:
    y, x = np.mgrid[0:300, 0:400] + 0.5
    seen = np.hypot(x - hidden.cx, y - hidden.cy) <= hidden.r
    seen &= np.hypot(x - front.cx, y - front.cy) > front.r
    return Silhouette(seen.astype(np.uint8), 0, 0)


@pytest.mark.parametrize("method", METHODS)
def test_a_cap_in_full_view_is_found_where_it_is_and_as_large_as_it_is(method: str):
    (found,) = reconstruct([outline(Circle(cx=120.3, cy=80.7, r=40))], method=method, **SIZE)
    assert found.fit.centre == pytest.approx((120.3, 80.7), abs=0.25)
    assert found.fit.whole is not None
    assert diameter_of_shape(found.fit.whole) == pytest.approx(80, abs=0.8)
    assert found.shape == "regular"
    assert found.fit.refusal is None


@pytest.mark.parametrize("method", METHODS)
def test_a_mask_symmetric_about_a_pixel_centre_has_its_centre_there(method: str):
    y, x = np.mgrid[0:41, 0:41]
    mask = (np.hypot(x - 20, y - 20) <= 15.2).astype(np.uint8)
    (found,) = reconstruct_silhouettes([Silhouette(mask, 100, 50)], method=method, **SIZE)
    assert found.fit.centre == pytest.approx((120.5, 70.5), abs=0.02)


def test_the_paper_recovers_a_cap_a_third_of_which_is_hidden_where_the_plain_ellipse_does_not():
    cap, front = Circle(cx=180, cy=150, r=45), Circle(cx=225, cy=150, r=40)
    errors = {}
    for method in ("paper", "literal", "ellipse"):
        (found,) = reconstruct_silhouettes([crescent(cap, front)], method=method, **SIZE)
        assert found.fit.centre is not None
        errors[method] = math.dist(found.fit.centre, (cap.cx, cap.cy))
    assert errors["paper"] < 0.6
    assert errors["literal"] > 5
    assert errors["ellipse"] > 5


def test_the_hull_goes_straight_over_the_hollow_that_a_cap_in_front_cuts():
    cap, front = Circle(cx=180, cy=150, r=45), Circle(cx=245, cy=150, r=40)
    errors = {}
    for method in ("hull", "ellipse"):
        (found,) = reconstruct_silhouettes([crescent(cap, front)], method=method, **SIZE)
        assert found.fit.centre is not None
        errors[method] = math.dist(found.fit.centre, (cap.cx, cap.cy))
    assert errors["hull"] < 1
    assert errors["ellipse"] > 2


@pytest.mark.parametrize("method", ["ellipse", "hull"])
def test_a_mask_too_small_for_an_ellipse_gets_the_circle_around_it(method: str):
    (found,) = reconstruct_silhouettes([Silhouette(np.ones((2, 2), np.uint8), 20, 30)], method=method, **SIZE)
    assert found.fit.centre == pytest.approx((21, 31))
    assert "enclosing circle" in found.why


def test_the_paper_says_why():
    (found,) = reconstruct_silhouettes(
        [crescent(Circle(cx=180, cy=150, r=45), Circle(cx=225, cy=150, r=40))], method="paper", **SIZE
    )
    assert found.shape == "irregular"
    assert found.why.startswith("irregular: 2 corners; longest piece ")
    assert "C* " in found.why


def test_read_literally_no_concavity_makes_a_cap_irregular():
    (found,) = reconstruct_silhouettes(
        [crescent(Circle(cx=180, cy=150, r=45), Circle(cx=225, cy=150, r=40))], method="literal", **SIZE
    )
    assert found.shape == "regular"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "cap",
    [
        [],
        [[]],
        [[1.0, 1.0, 5.0, 5.0]],
        [[500.0, 10.0, 520.0, 10.0, 510.0, 30.0]],
        [[1.0, 1.0, math.nan, 5.0, 9.0, 1.0]],
    ],
    ids=["no parts", "an empty part", "two points", "outside the image", "not a number"],
)
def test_a_cap_of_which_nothing_can_be_seen_is_refused_and_its_neighbour_is_not(
    method: str, cap: list[list[float]]
):
    first, second = reconstruct([cap, outline(Circle(cx=100, cy=100, r=20))], method=method, **SIZE)
    assert first.fit.centre is None
    assert first.fit.whole is None
    assert first.fit.refusal
    assert second.fit.centre == pytest.approx((100, 100), abs=0.3)


def test_an_unknown_method_is_an_error():
    with pytest.raises(KeyError, match="guess"):
        reconstruct([], method="guess", **SIZE)


def check(found: Reconstruction, cap: Silhouette) -> None:
    assert found.fit.whole is not None
    assert found.fit.centre is not None
    numbers = msgspec.structs.astuple(found.fit.whole)
    assert all(math.isfinite(value) for value in (*numbers, *found.fit.centre, *(found.fit.centre_sd or ())))
    # Parts much smaller than the longest are crumbs, which neither draw the centre nor bound it.
    contours = contours_of(cap)
    parts = [np.concatenate(contours[: count + 1]) for count in range(len(contours))]
    assert any(is_within_reach(found.fit.centre, enclosing_circle(part)) for part in parts)


def is_within_reach(centre: tuple[float, float], around: Circle) -> bool:
    return math.dist(centre, (around.cx, around.cy)) <= around.r + 1


@pytest.mark.parametrize("method", METHODS)
@given(bits=st.lists(st.booleans(), min_size=49, max_size=49))
def test_any_mask_gives_finite_numbers_near_it(method: str, bits: list[bool]):
    mask = np.array(bits, np.uint8).reshape(7, 7)
    cap = Silhouette(mask, 30, 40)
    (found,) = reconstruct_silhouettes([cap], method=method, width=1100, height=1100)
    if not mask.any():
        assert found.fit.refusal
    else:
        check(found, Silhouette(mask, 30, 40))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("size", [(1, 1), (1, 2), (2, 2), (1, 40), (3, 3), (40, 1), (1000, 1000), (600, 3)])
def test_caps_from_one_pixel_to_a_thousand_get_an_answer(method: str, size: tuple[int, int]):
    cap = Silhouette(np.ones(size, np.uint8), 5, 5)
    (found,) = reconstruct_silhouettes([cap], method=method, width=1100, height=1100)
    check(found, cap)
    assert found.fit.centre == pytest.approx((5 + size[1] / 2, 5 + size[0] / 2), abs=0.6)
