import json
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.coco.visible import outline_in
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon
from fairyring.storage.formats.coco import parse_coco
from fairyring.storage.formats.found import FoundCategory, Problem

SQUARE = [10, 10, 30, 10, 30, 30, 10, 30]


def parse(annotations=(), *, images=None, **keys):
    images = [{"id": 1, "file_name": "bed.png", "width": 100, "height": 80}] if images is None else images
    document = {
        "images": images,
        "annotations": [
            {"id": number, "image_id": 1, "category_id": 1} | entry if isinstance(entry, dict) else entry
            for number, entry in enumerate(annotations, start=1)
        ],
        "categories": [{"id": 1, "name": "mushroom"}],
    }
    return parse_coco(json.dumps(document | keys).encode(), file="f.json")


def only_cap(entry):
    found = parse([entry])
    assert found.problems == []
    (image,) = found.images
    (cap,) = image.caps
    return cap


def reasons(found):
    return [(problem.where, problem.reason) for problem in found.problems]


def test_polygons_of_several_parts_stay_apart():
    parts = [SQUARE, [50, 50, 60, 50, 55, 60]]
    assert only_cap({"segmentation": parts}).cap.visible == parts


def test_a_flat_list_is_one_part():
    assert only_cap({"segmentation": SQUARE}).cap.visible == [SQUARE]


@pytest.mark.parametrize(
    "rle",
    [
        # Columns come first: row 3 of column 0 and row 0 of column 1.
        {"size": [4, 4], "counts": [3, 2, 11]},
        {"size": [4, 4], "counts": "32;"},
    ],
)
def test_both_kinds_of_rle_are_the_pixels_they_name(rle):
    from pycocotools import mask

    cap = only_cap({"segmentation": rle, "iscrowd": 1})
    assert cap.cap.ignored
    outline = outline_in(cap.rle, width=4, height=4)
    drawn = mask.decode(mask.merge(mask.frPyObjects(outline, 4, 4)))
    assert sorted(zip(*drawn.nonzero(), strict=True)) == [(0, 1), (3, 0)]


MARKS = [
    ({"circle": [20, 21, 5]}, Circle(20, 21, 5)),
    ({"ellipse": [20, 21, 5, 4, 30]}, Ellipse(20, 21, 5, 4, 30)),
    ({"ellipse": [20, 21, 4, 5, 30]}, Ellipse(20, 21, 5, 4, 120)),
    ({"ellipse": [20, 21, 5, 4, 190]}, Ellipse(20, 21, 5, 4, 10)),
    ({"mark": SQUARE, "marked": True, "ellipse": [20, 20, 5, 4, 3]}, Polygon(SQUARE)),
    ({"amodal_segmentation": [SQUARE]}, Polygon(SQUARE)),
    ({"ellipse": [20, 21, 5, 4, 30], "marked": False}, None),
    ({"circle": [20, 21, 5], "score": 0.5}, None),
    ({"circle": [20, 21, 5], "center_sd": [0.1, 0.1]}, None),
    ({"circle": None, "ellipse": None, "center": None}, None),
]


@pytest.mark.parametrize(("keys", "mark"), MARKS)
def test_a_shape_is_a_mark_where_a_person_placed_it(keys, mark):
    cap = only_cap({"segmentation": [SQUARE]} | keys)
    assert cap.cap.mark == mark
    if "circle" in keys and mark is None and keys["circle"]:
        assert cap.whole == Circle(20, 21, 5)


def test_an_outline_drawn_from_the_mark_is_not_taken_for_one_that_was_seen():
    drawn = {"segmentation": [SQUARE], "circle": [20, 20, 10], "marked": True, "segmentation_of": "mark"}
    assert only_cap(drawn).cap.visible == []


def test_flags_order_score_and_number_are_read():
    cap = only_cap({"segmentation": [SQUARE], "doubt": True, "ignore": 1, "order": 4, "score": 1, "uid": "x"})
    assert (cap.cap.doubtful, cap.cap.ignored, cap.cap.order, cap.score, cap.uid) == (True, True, 4, 1.0, "x")


def test_unknown_keys_are_kept_and_known_ones_are_not_repeated():
    cap = only_cap({"segmentation": [SQUARE], "bbox": [1, 2, 3, 4], "area": 5, "source": {"by": ["me"]}})
    assert cap.extra == {"source": {"by": ["me"]}}
    found = parse(
        images=[{"id": 1, "file_name": "b.png", "light": "dark", "form": "h", "split": "x", "camera": 7}],
        categories=[{"id": 1, "name": "mushroom", "supercategory": "fungus"}],
    )
    (image,) = found.images
    assert (image.light, image.form, image.split, image.extra) == ("dark", "h", "x", {"camera": 7})
    assert (image.width, image.height) == (None, None)
    assert found.categories == {"mushroom": FoundCategory(id=1, extra={"supercategory": "fungus"})}


def test_a_licence_travels_with_its_image():
    found = parse(
        images=[{"id": 1, "file_name": "b.png", "license": 3}], licenses=[{"id": 3, "name": "MIT", "url": ""}]
    )
    assert found.images[0].extra == {"license": {"id": 3, "name": "MIT", "url": ""}}


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        ({"category_id": 9, "segmentation": [SQUARE]}, "There is no category 9."),
        ({"category_id": [], "segmentation": [SQUARE]}, "There is no category []."),
        ({"segmentation": "many"}, "Its segmentation is neither a list of polygons nor an RLE."),
        ({"segmentation": [SQUARE], "circle": [1, 2]}, "Its circle is not 3 finite numbers."),
        ({"segmentation": [SQUARE], "circle": [1, 2, True]}, "Its circle is not 3 finite numbers."),
        ({"segmentation": [SQUARE], "center": [1, float("nan")]}, "Its center is not 2 finite numbers."),
        ({"segmentation": [SQUARE], "center": [1, 10**400]}, "Its center is not 2 finite numbers."),
        ({"segmentation": [SQUARE], "ellipse": {"cx": 1}}, "Its ellipse is not 5 finite numbers."),
        ({"segmentation": [SQUARE], "score": "high"}, "Its score is not a finite number."),
        ({"segmentation": [SQUARE], "iscrowd": 2}, "“iscrowd” is neither true nor false."),
        ({"segmentation": [SQUARE], "doubt": "no"}, "“doubt” is neither true nor false."),
    ],
)
def test_one_bad_annotation_is_reported_and_the_next_is_taken(entry, reason):
    found = parse([entry, {"segmentation": [SQUARE]}])
    assert len(found.images[0].caps) == 1
    ((where, said),) = reasons(found)
    assert where == "annotation 1"
    assert reason in said


def test_annotations_of_a_missing_image_are_counted_once():
    found = parse([{"image_id": 7}, {"image_id": 7}, {"image_id": None}, 5, {"segmentation": [SQUARE]}])
    assert reasons(found) == [
        ("annotation at place 4", "It is not an object."),
        ("image 7", "It is missing or was left out, and 2 annotations with it."),
        ("", "Of 1 annotations it is not said which image they belong to."),
    ]
    assert len(found.images[0].caps) == 1


def test_duplicate_ids_are_reported():
    image = {"id": 1, "file_name": "bed.png"}
    found = parse(
        [{"id": 5, "segmentation": [SQUARE]}] * 2, images=[image, image | {"file_name": "other.png"}]
    )
    assert [image.file_name for image in found.images] == ["bed.png"]
    assert reasons(found) == [
        ("image 1", "Another image has this id; only the first is taken."),
        ("annotation 5", "2 annotations have this id; it is that of the first."),
    ]
    assert len(found.images[0].caps) == 2


@pytest.mark.parametrize(
    ("image", "reason"),
    [
        ({"file_name": "b.png"}, "The id is missing"),
        ({"id": 1.5, "file_name": "b.png"}, "The id is missing"),
        ({"id": 1}, "The file name is missing."),
        ({"id": 1, "file_name": 7}, "The file name is missing."),
        ({"id": 1, "file_name": "a/.."}, "is no file name"),
        ({"id": 1, "file_name": "b.png", "width": -1}, "The width is not a positive whole number."),
        ({"id": 1, "file_name": "b.png", "height": "80"}, "The height is not a positive whole number."),
        ("bed.png", "It is not an object."),
    ],
)
def test_an_image_that_makes_no_sense_is_left_out(image, reason):
    images = [image, {"id": 2, "file_name": "good.png"}]
    found = parse(images=images)
    assert [image.file_name for image in found.images] == ["good.png"]
    assert reason in found.problems[0].reason


@pytest.mark.parametrize("key", ["note", "light", "license"])
def test_what_cannot_be_written_again_is_left_out_and_the_image_taken(key):
    image = {"id": 1, "file_name": "b.png", "camera": 7, key: "half a \ud800"}
    found = parse(images=[image])
    assert [image.extra for image in found.images] == [{"camera": 7}]
    assert f"Its {key} cannot be kept" in found.problems[-1].reason


def test_images_of_one_base_name_in_two_folders_are_two():
    images = [{"id": 1, "file_name": "monday/1.png"}, {"id": 2, "file_name": "tuesday/1.png"}]
    found = parse([{"segmentation": [SQUARE]}, {"image_id": 2, "segmentation": [SQUARE]}], images=images)
    assert [(image.file_name, len(image.caps)) for image in found.images] == [
        ("monday/1.png", 1),
        ("tuesday/1.png", 1),
    ]
    assert reasons(found) == []


def test_an_image_that_is_listed_twice_is_reported():
    images = [{"id": 1, "file_name": "a\\1.png"}, {"id": 2, "file_name": "./a/1.png"}]
    found = parse([{"segmentation": [SQUARE]}], images=images)
    assert [image.file_name for image in found.images] == ["a/1.png"]
    assert reasons(found) == [("image 2", "Another image of this file is called 1.png too; rename one.")]


def test_a_category_with_keys_that_cannot_be_kept_is_still_a_category():
    found = parse([{"segmentation": [SQUARE]}], categories=[{"id": 1, "name": "mushroom", "note": "\udfff"}])
    assert found.categories == {"mushroom": FoundCategory(id=1)}
    assert len(found.images[0].caps) == 1


def test_a_category_without_a_name_is_reported_also_where_no_cap_is_of_it():
    categories = [{"id": 1, "name": "mushroom"}, {"id": 2, "name": 7}]
    found = parse([{"segmentation": [SQUARE]}], categories=categories)
    assert found.categories == {"mushroom": FoundCategory(id=1)}
    assert reasons(found) == [("category 2", "The name of category 2 is not a line of 1 to 200 letters.")]


def test_categories_without_an_id_or_with_that_of_another_are_told():
    categories = [{"id": 1, "name": "mushroom"}, {"name": "stalk", "note": "rare"}, {"id": 1, "name": "soil"}]
    found = parse([{"segmentation": [SQUARE]}], categories=categories)
    assert found.categories == {
        "mushroom": FoundCategory(id=1),
        "stalk": FoundCategory(extra={"note": "rare"}),
    }
    assert reasons(found) == [
        ("category at place 2", "stalk has no id, so nothing can be of it; it gets one here."),
        ("category 1", "Another category has its id; soil was left out."),
    ]


@pytest.mark.parametrize("box", [[50, 50, -20, 10], [50, 50, 20, -10], [50, 50, 0, 10]])
def test_a_box_that_is_turned_or_has_no_area_is_not_guessed_at(box):
    found = parse([{"bbox": box}])
    assert found.images[0].caps == []
    assert [reason.split(";")[1] for _, reason in reasons(found)] == [" after x and y it needs both above 0."]


def test_how_long_a_name_is_that_is_too_long_is_told():
    found = parse([], categories=[{"id": 1, "name": "x" * 300}])
    assert reasons(found) == [
        ("category 1", "The name of category 1 is not a line of 1 to 200 letters, but of 300.")
    ]


def test_an_unknown_light_does_not_keep_the_image_out():
    found = parse(images=[{"id": 1, "file_name": "b.png", "light": "sun"}])
    assert found.images[0].light is None
    assert found.images[0].extra == {"light": "sun"}
    assert reasons(found) == [("image 1", "The light is none of top, side, dark; it was left out.")]


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not JSON"),
        (b"{", "not JSON"),
        (b"\xff\xfe{}", "not JSON"),
        (b"\x1f\x8b{}", "damaged gzip"),
        (b"5", "neither a COCO file with a list of images"),
        (b"{}", "neither a COCO file with a list of images"),
        (b'{"images": {}}', "neither a COCO file with a list of images"),
        (b'{"images": [], "annotations": 5}', "annotations are not a list"),
        (b"[]", "a list without results"),
        (b"[" * 100_000, "nested too deeply"),
    ],
)
def test_what_is_no_coco_file_is_refused(data, reason):
    with pytest.raises(FairyringError, match=reason):
        parse_coco(data, file="f.json")


def test_a_byte_order_mark_is_no_obstacle():
    assert parse_coco(b'\xef\xbb\xbf{"images": []}', file="f.json").images == []


def test_a_problem_reads_as_one_line():
    assert str(Problem("f.json", "annotation 3", "It is bad.")) == "f.json: annotation 3: It is bad."
    assert str(Problem("f.json", "", "It is bad.")) == "f.json: It is bad."


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=8,
)
IMAGE_KEYS = ["id", "file_name", "width", "light", "license"]
KEYS = ["id", "image_id", "category_id", "segmentation", "iscrowd", "circle", "ellipse", "center", "score"]
KEYS += ["mark", "marked", "amodal_segmentation", "ignore", "doubt", "order", "uid", "segmentation_of"]


@settings(max_examples=150)
@given(
    annotations=st.lists(st.dictionaries(st.sampled_from(KEYS), anything) | anything, max_size=3),
    images=st.lists(st.dictionaries(st.sampled_from(IMAGE_KEYS), anything) | anything, max_size=2),
    categories=anything,
)
def test_whatever_a_file_holds_it_is_read_or_refused_in_words(annotations, images, categories):
    with suppress(FairyringError):
        parse(annotations, images=images, categories=categories, licenses=categories)
