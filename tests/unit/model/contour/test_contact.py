import numpy as np
import pytest

from fairyring.model.contour.contact import NOBODY, contact_of
from fairyring.model.contour.rims import rims_of
from fairyring.model.contour.silhouette import Silhouette

SIZE = {"width": 400, "height": 300}


def block(*, left: int, top: int, width: int, height: int) -> Silhouette:
    return Silhouette(np.ones((height, width), np.uint8), left, top)


def test_a_rim_point_sees_the_nearest_cap_outside_it_or_the_border_or_nobody():
    cap = block(left=0, top=100, width=40, height=40)
    beside = block(left=42, top=90, width=30, height=60)
    rims = rims_of([cap])
    contact = contact_of(rims, [cap, beside], **SIZE)
    x, y = rims.points[0].T
    upright = (y > 105) & (y < 135)
    assert contact.border[0][(x < 5) & upright].all()
    assert (contact.neighbour[0][(x > 35) & upright] == 1).all()
    assert (contact.neighbour[0][(y < 104) & (x > 5) & (x < 35)] == NOBODY).all()
    assert (contact.free == (contact.neighbour == NOBODY) & ~contact.border).all()


@pytest.mark.parametrize("swapped", [False, True])
def test_of_two_masks_that_overlap_the_smaller_one_is_seen_whatever_their_order(swapped: bool):
    cap = block(left=100, top=100, width=40, height=40)
    large, small = (
        block(left=140, top=90, width=30, height=60),
        block(left=140, top=110, width=10, height=20),
    )
    others = [small, large] if swapped else [large, small]
    rims = rims_of([cap])
    neighbour = contact_of(rims, [cap, *others], **SIZE).neighbour[0]
    x, y = rims.points[0].T
    right = x > 137
    assert (neighbour[right & (y > 112) & (y < 128)] == 1 + others.index(small)).all()
    assert (neighbour[right & (y > 102) & (y < 108)] == 1 + others.index(large)).all()
