import numpy as np
import pytest

from fairyring.model.contour.arch import (
    arch_curvature,
    arch_height,
    arch_radius,
    arch_ratio,
    chord_length,
    inscribed_triangle_areas,
)


def arc(degrees: float, radius: float = 40.0, points: int = 20001) -> np.ndarray:
    angle = np.radians(np.linspace(0, degrees, points))
    return radius * np.column_stack([np.cos(angle), np.sin(angle)]) + (200, 100)


def test_equation_4_is_one_over_the_radius():
    assert arch_curvature(50) == 0.02


def test_equation_5_gives_the_radius_of_a_known_arc():
    # A chord of 8 and a height of 2 belong to a circle of radius 5 (3, 4, 5).
    assert arch_radius(chord=8, height=2) == pytest.approx(5)


def test_equation_5_as_printed_takes_the_whole_chord():
    assert arch_radius(chord=8, height=2, whole_chord=True) == pytest.approx(17)


def test_equation_6_is_the_distance_between_the_ends():
    assert chord_length(np.array([[1.0, 1.0], [9.0, 9.0], [4.0, 5.0]])) == 5


def test_equation_8_gives_the_area_of_a_right_triangle_and_nothing_at_the_ends():
    areas = inscribed_triangle_areas(np.array([[0.0, 0.0], [0.0, 3.0], [4.0, 0.0]]))
    assert areas == pytest.approx([0, 6, 0], abs=1e-6)


def test_equation_7_is_the_height_over_the_chord():
    assert arch_height(np.array([[0.0, 0.0], [1.0, 3.0], [4.0, 0.0]])) == pytest.approx(3)
    assert arch_height(arc(180)) == pytest.approx(40, abs=1e-3)


def test_equation_7_takes_the_farthest_point_where_the_ends_meet():
    assert arch_height(arc(360)) == pytest.approx(80, abs=1e-3)


@pytest.mark.parametrize(("degrees", "ratio"), [(180, 0.5), (201, 0.601), (244, 0.902)])
def test_the_arch_ratio_is_half_the_tangent_of_a_quarter_of_the_angle(degrees: float, ratio: float):
    assert arch_ratio(arc(degrees)) == pytest.approx(ratio, abs=1e-3)
    assert arch_ratio(arc(degrees)) == pytest.approx(np.tan(np.radians(degrees) / 4) / 2, abs=1e-5)


def test_the_radius_of_an_arc_comes_back_from_its_chord_and_height():
    for degrees in (60, 120, 200, 300):
        piece = arc(degrees)
        radius = arch_radius(chord=chord_length(piece), height=arch_height(piece))
        assert radius == pytest.approx(40, rel=1e-4)
