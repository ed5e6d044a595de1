import json

import pytest

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.choices import Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.labelme import parse_labelme

TRIANGLE = [[10, 10], [30, 10], [20, 30]]
FLAT = [10, 10, 30, 10, 20, 30]


def shape(points=TRIANGLE, **keys):
    return {
        "label": "mushroom",
        "points": points,
        "group_id": None,
        "shape_type": "polygon",
        "flags": {},
    } | keys


def parse(*shapes, polygons=Polygons.visible, **keys):
    document = {"version": "5.0", "shapes": list(shapes), "imagePath": "bed.png", "imageData": None}
    return parse_labelme(json.dumps(document | keys).encode(), file="bed.json", polygons=polygons)


def caps(*shapes, **keys):
    found = parse(*shapes, **keys)
    assert found.problems == []
    return [cap.cap for cap in found.images[0].caps]


def test_a_polygon_is_the_visible_outline_and_where_asked_for_the_mark():
    (cap,) = caps(shape())
    assert (cap.visible, cap.mark, cap.category) == ([FLAT], None, "mushroom")
    (marked,) = caps(shape(), polygons=Polygons.marks)
    assert (marked.visible, marked.mark) == ([FLAT], Polygon(FLAT))
    assert parse(shape(), shape([[20, 20], [23, 24]], shape_type="circle")).polygons == 1


def test_a_circle_is_its_centre_and_a_point_on_its_rim():
    (cap,) = caps(shape([[20, 20], [23, 24]], shape_type="circle"))
    assert (cap.visible, cap.mark) == ([], Circle(20, 20, 5))


def test_shapes_of_one_group_and_label_are_one_cap():
    parts = caps(
        shape(group_id=1),
        shape([[50, 50], [60, 50], [55, 60]], group_id=1),
        shape(group_id=2),
        polygons=Polygons.marks,
    )
    assert [len(cap.visible) for cap in parts] == [2, 1]
    assert [cap.mark for cap in parts] == [None, Polygon(FLAT)]
    rim = shape([[20, 20], [20, 30]], shape_type="circle", group_id=3)
    for polygons in Polygons:
        (both,) = caps(shape(group_id=3), rim, polygons=polygons)
        assert (both.visible, both.mark) == ([FLAT], Circle(20, 20, 10))
    assert len(caps(shape(group_id=1), shape(group_id=1, label="button"))) == 2


def test_a_group_with_two_circles_is_a_cluster_and_not_a_cap():
    circle = shape([[20, 20], [20, 30]], shape_type="circle", group_id=1)
    assert len(caps(circle, circle, shape(group_id=1))) == 3


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (shape([[1, 1], [2, 2], [3, 1]], shape_type="circle"), "A circle is two points"),
        (shape([[1, 1]], shape_type="circle"), "this has 1"),
        (shape(shape_type="linestrip"), "Shapes of type 'linestrip' are not known here"),
        (shape(shape_type="mask"), "Its mask is no PNG"),
        (shape(shape_type="mask", mask="iVBORw0KGgo="), "Its mask is no PNG"),
        (shape(shape_type=["polygon"]), "are not known here"),
        (shape([[1, 1], [2, 2], [float("nan"), 1]]), "A point is not 2 finite numbers"),
        (shape([[1, 1], [2, 2], [True, 1]]), "A point is not 2 finite numbers"),
        (shape([[1, 1], [2, 2], [3]]), "A point is not 2 finite numbers"),
        (shape(label=""), "The label"),
        (shape(label=5), "The label"),
        (shape(points=None), "no points"),
        ("circle", "no points"),
    ],
)
def test_one_bad_shape_is_reported_and_the_next_is_taken(bad, reason):
    found = parse(bad, shape())
    assert len(found.images[0].caps) == 1
    (problem,) = found.problems
    assert (problem.file, problem.where) == ("bed.json", "shape 1")
    assert reason in problem.reason


def test_unknown_keys_are_kept():
    found = parse(shape(flags={"wet": True}, description="big", score=None), flags={"day": 3}, imageHeight=80)
    assert found.images[0].extra == {"flags": {"day": 3}}
    assert found.images[0].height == 80
    assert found.images[0].caps[0].extra == {"flags": {"wet": True}, "description": "big"}


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"imagePath": None}, "does not name its image"),
        ({"shapes": {}}, "no list of shapes"),
        ({"imageWidth": "wide"}, "imageWidth is not a positive whole number"),
    ],
)
def test_what_is_no_labelme_file_is_named(keys, reason):
    with pytest.raises(StoreError, match=reason):
        parse(**keys)


def test_a_shape_keeps_the_numbers_that_somebody_wrote_beside_it():
    square = [[10, 10], [30, 10], [30, 30], [10, 30]]
    shape = {"label": "mushroom", "points": square, "shape_type": "polygon", "id": 12, "uid": "cap-12"}
    document = {"shapes": [shape], "imagePath": "bed.png", "imageWidth": 100, "imageHeight": 80}
    (image,) = parse_labelme(json.dumps(document).encode(), file="f.json").images
    (cap,) = image.caps
    assert (cap.id, cap.uid, cap.extra) == (12, "cap-12", {})
