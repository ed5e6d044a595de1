"""What is exported and imported again is the same."""

import json

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon, fit_of_shape
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage.contents import load_annotations, load_predictions
from fairyring.storage.formats.coco import parse_coco
from fairyring.storage.formats.coco_geometry import geometry_keys
from fairyring.storage.formats.coco_writing import annotation_entry, drawn
from fairyring.storage.images import get_image, set_light_and_form
from fairyring.storage.importing.cap_checks import check_caps
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.importing.photos import Photo
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import create_project
from fairyring.storage.records import Annotation, Cap, Edit
from fairyring.storage.splits import set_splits
from fairyring.storage.statuses import set_status
from tests.support.exported import SQUARE, TRIANGLE, export, store


def test_what_is_exported_and_imported_into_a_new_project_is_the_same(beds, out, tmp_path):
    """Of every kind of cap, through real files."""
    stored = [
        Cap(
            visible=[SQUARE, TRIANGLE],
            doubtful=True,
            order=2,
            arcs=[ToldArc(kind="hidden", points=SQUARE[:4])],
        ),
        Cap(visible=[SQUARE], mark=Circle(20.25, 20.5, 11.125), ignored=True),
        Cap(visible=[TRIANGLE], mark=Ellipse(50, 46, 11, 10, 45), category="mushroom"),
        Cap(visible=[SQUARE], mark=Polygon(SQUARE)),
        Cap(visible=[], mark=Circle(70, 60, 9)),
    ]
    store(beds, *stored)
    export(beds, out, with_ignored=True)
    with create_project(tmp_path / "other") as other:
        report = import_paths(other, [out])
        assert (report.images, report.annotations, report.problems) == (1, 5, [])
        with beds.read() as ours, other.read() as theirs:
            assert [a.cap for a in load_annotations(theirs, 1)] == [a.cap for a in load_annotations(ours, 1)]
    assert import_paths(beds, [out]).known == 5


def test_how_sure_a_centre_is_is_exported_and_comes_back_until_the_cap_is_edited(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE], mark=Polygon(SQUARE)), whole=Circle(20, 20, 14), centre_sd=(0.3, 0.4))
    store(beds, Cap(visible=[TRIANGLE]), image=2, whole=Circle(50, 46, 11), centre_sd=(0.5, 0.6))
    store(beds, Cap(visible=[TRIANGLE]), image=3, whole=Circle(50, 46, 11))
    marked, worked_out, unknown = export(beds, out)["annotations"]
    assert (marked["mark_sd"], worked_out["center_sd"]) == ([0.3, 0.4], [0.5, 0.6])
    assert not {"center_sd", "mark_sd"} & {*unknown}
    assert "center_sd" not in marked  # it would say that a machine worked the centre out
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out])
        with other.read() as connection:
            first, second, third = (load_annotations(connection, image)[0] for image in (1, 2, 3))
        assert [each.centre_sd for each in (first, second, third)] == [(0.3, 0.4), (0.5, 0.6), None]
        assert first.cap.mark == Polygon(SQUARE)
        edit = Edit(id="e", annotation=second.uid, image=2, base=1, cap=Cap(visible=[SQUARE]))
        commit(other, [Derived(edit=edit)], user="ann")
        assert "center_sd" not in export(other, tmp_path / "again")["annotations"][1]


def test_predictions_exported_and_imported_again_are_the_same(mixed, out, tmp_path):
    export(mixed, out, only="predicted")
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out], as_="predictions")
        with other.read() as theirs, mixed.read() as ours:
            (mine,) = load_predictions(ours, 3)
            (copy,) = load_predictions(theirs, 3)
    assert (copy.visible, copy.score, copy.whole, copy.centre) == (mine.visible, 0.5, mine.whole, mine.centre)
    assert (copy.quality, copy.extra.get("quality")) == (0.875, None)


def test_extra_keys_and_licences_come_back(beds, tmp_path, out, write_coco):
    image = {"id": 1, "file_name": "bed_1.png", "license": 4, "camera": "left", "split": "train"}
    licenses = [{"id": 4, "name": "MIT", "url": "https://example.org"}]
    categories = [{"id": 1, "name": "mushroom", "supercategory": "fungus"}]
    entry = {"segmentation": [SQUARE], "source": {"by": "me"}, "id": 77}
    import_paths(beds, [write_coco([entry], images=[image], licenses=licenses, categories=categories)])
    document = export(beds, out)
    assert document["licenses"] == [{"name": "MIT", "url": "https://example.org", "id": 1}]
    assert {key: document["images"][0][key] for key in ("license", "camera", "split")} == {
        "license": 1,
        "camera": "left",
        "split": "train",
    }
    assert document["categories"][0]["supercategory"] == "fungus"
    assert document["annotations"][0]["source"] == {"by": "me"}
    assert document["annotations"][0]["id"] == 77
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out])
        again = export(other, tmp_path / "again")
    assert again == document | {"info": again["info"]}


def test_the_true_whole_outline_of_a_file_is_kept_until_the_cap_is_edited(beds, tmp_path, out, write_coco):
    true = [[5, 5, 35, 6, 34, 36, 6, 33]]
    entry = {"segmentation": [SQUARE], "ellipse": [20, 20, 15, 14, 0], "amodal_segmentation": true}
    import_paths(beds, [write_coco([entry])])
    (annotation,) = export(beds, out)["annotations"]
    assert annotation["amodal_segmentation"] == true
    edit = Edit(id="e", annotation=annotation["uid"], image=1, base=1, cap=Cap(visible=[SQUARE]))
    commit(beds, [Derived(edit=edit, fit=fit_of_shape(Circle(20, 20, 14)))], user="ann")
    (edited,) = export(beds, tmp_path / "again")["annotations"]
    assert edited["amodal_segmentation"] != true
    assert edited["circle"] == [20, 20, 14]


near = st.floats(12, 60)
circles = st.builds(Circle, near, near, st.floats(1, 30))
ellipses = st.builds(
    lambda x, y, b, more, t: Ellipse(x, y, b + more, b, t), near, near, near, near, st.floats(0, 179)
)
corners = st.tuples(st.floats(0, 30), st.floats(0, 30), st.floats(40, 90), st.floats(35, 70))
boxes = corners.map(lambda c: [c[0], c[1], c[2], c[1], c[2], c[3], c[0], c[3]])
caps = st.builds(
    Cap,
    visible=st.lists(boxes, min_size=1, max_size=2),
    mark=st.none() | circles | ellipses | boxes.map(Polygon),
    ignored=st.booleans(),
    doubtful=st.booleans(),
    order=st.none() | st.integers(-9, 9),
) | st.builds(Cap, visible=st.just([]), mark=circles | ellipses)


def written_and_read(stored):
    """The caps as the entries of a file give them back; numbered to tell them apart."""
    annotations = [Annotation(uid=f"cap_{n}", image=1, revision=1, cap=cap) for n, cap in enumerate(stored)]
    geometry = geometry_keys([drawn(each) for each in annotations], size=(100, 80))
    entries = [
        annotation_entry(a, keys, number=n, category=1)
        for n, (a, keys) in enumerate(zip(annotations, geometry, strict=True), start=1)
    ]
    document = {
        "images": [{"id": 1, "file_name": "bed.png", "width": 100, "height": 80}],
        "categories": [{"id": 1, "name": "mushroom"}],
        "annotations": entries,
    }
    found = parse_coco(json.dumps(document).encode(), file="f.json")
    photo = Photo(file_name="bed.png", width=100, height=80, sha256="")
    fitted, problems = check_caps(found.images[0].caps, photo=photo, file="f.json")
    assert found.problems == problems == []
    assert [cap.uid for cap in fitted] == [annotation.uid for annotation in annotations]
    return [cap.cap for cap in fitted]


@settings(max_examples=150)
@given(stored=st.lists(caps, min_size=1, max_size=3))
def test_a_cap_that_is_written_and_read_again_is_the_same(stored):
    """Coordinates to the fourth decimal, the second time exactly; the rest exactly."""
    once = written_and_read(stored)
    for mine, copy in zip(stored, once, strict=True):
        assert (copy.ignored, copy.doubtful, copy.order) == (mine.ignored, mine.doubtful, mine.order)
        assert type(copy.mark) is type(mine.mark)
        assert np.allclose(flat(copy), flat(mine), rtol=0, atol=6e-5)
    assert written_and_read(once) == once


def flat(cap):
    shape = cap.mark
    numbers = [] if shape is None else shape.points if isinstance(shape, Polygon) else list(vars_of(shape))
    return [*numbers, *(coordinate for part in cap.visible for coordinate in part)]


def vars_of(shape):
    return (getattr(shape, name) for name in shape.__struct_fields__)


def test_status_split_light_and_form_of_images_survive(beds, out, tmp_path):
    said = {1: ("new", "train"), 2: ("annotated", "val"), 3: ("approved", None)}

    def say(connection):
        set_splits(connection, {number: split for number, (_, split) in said.items()})
        for number, (status, _) in said.items():
            set_status(connection, number, status, user="ann")
            set_light_and_form(connection, number, light="dark", form="h")

    beds.write(say)
    export(beds, out, only="all")
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out])
        with other.read() as connection:
            images = [get_image(connection, number) for number in said]
    assert {image.id: (image.status, image.split) for image in images} == said
    assert {(image.light, image.form) for image in images} == {("dark", "h")}


def test_of_one_state_every_export_is_the_same_byte_for_byte(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]))
    export(beds, out)
    export(beds, tmp_path / "again")
    assert (out / "instances.json").read_bytes() == (tmp_path / "again" / "instances.json").read_bytes()


def test_the_whole_outline_holds_the_visible_one(beds, out):
    """Its polygon is united with what is seen, and the circle in its own key stays exact."""
    store(beds, Cap(visible=[SQUARE]), whole=Circle(20, 20, 10))
    (annotation,) = export(beds, out)["annotations"]
    visible = mask_of_outline(annotation["segmentation"], width=100, height=80)
    whole = mask_of_outline(annotation["amodal_segmentation"], width=100, height=80)
    assert (visible & ~whole).sum() == 0
    assert whole.sum() == visible.sum() == 400
    assert annotation["circle"] == [20, 20, 10]
