import numpy as np

from fairyring.model.contour.rims import rims_of
from fairyring.model.contour.silhouette import Silhouette


def test_the_hull_of_a_disc_with_a_bite_has_corners_all_round_but_none_in_the_bite():
    row, column = np.mgrid[0:81, 0:81]
    seen = (np.hypot(column - 40, row - 40) <= 30) & (np.hypot(column - 70, row - 40) > 24)
    rims = rims_of([Silhouette(seen.astype(np.uint8), 0, 0)])
    corners = rims.points[0][rims.corner[0]] - 40.5
    assert (np.hypot(*corners.T) > 27).all()
    # The bite takes the sixth to the right on either side; elsewhere corners are never far apart.
    angles = np.sort(np.degrees(np.arctan2(*corners.T[::-1])) % 360)
    assert angles[0] > 35
    assert angles[-1] < 325
    assert np.diff(angles).max() < 40
