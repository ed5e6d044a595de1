import json
import math
from concurrent.futures import CancelledError

import cv2
import faster_coco_eval
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from pycocotools import mask
from pycocotools.coco import COCO

from model.geometry import Circle, Ellipse, Polygon
from storage.documents import load_annotations, load_predictions
from storage.errors import StoreError
from storage.exporting import export_coco
from storage.fitting import fit_caps
from storage.formats.coco import parse_coco
from storage.formats.coco_writing import annotation_entry
from storage.images import set_status
from storage.importing import import_paths
from storage.journal import Derived, commit
from storage.placing import Photo
from storage.predictions import NewPrediction, add_predictions, add_run
from storage.project import create_project
from storage.records import Annotation, Cap, Edit

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
TRIANGLE = [40.0, 40.0, 60.0, 40.0, 50.0, 60.0]


def store(project, *caps, image=1, **derived):
    edits = [
        Edit(id=f"{image} {n}", annotation=f"{image}_{n}", image=image, base=0, cap=cap)
        for n, cap in enumerate(caps)
    ]
    outcomes = commit(project, [Derived(edit=edit, **derived) for edit in edits], user="ann")
    assert all(type(outcome).__name__ == "Accepted" for outcome in outcomes), outcomes


def export(project, out, **keys):
    report = export_coco(project, out, **keys)
    document = json.loads((out / "instances.json").read_text())
    assert (report.images, report.annotations) == (len(document["images"]), len(document["annotations"]))
    return document


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"


def test_the_folder_holds_one_json_file_and_the_photos(beds, out):
    store(beds, Cap(visible=[SQUARE]), image=3)
    document = export(beds, out)
    assert sorted(str(file.relative_to(out)) for file in out.rglob("*")) == [
        "images",
        "images/bed_10.png",
        "instances.json",
    ]
    (image,) = document["images"]
    assert (image["id"], image["file_name"], image["width"], image["height"]) == (1, "bed_10.png", 100, 80)
    assert (out / "images/bed_10.png").read_bytes() == (beds.images / "bed_10.png").read_bytes()


def test_ids_count_from_1_in_one_stable_order(beds, out, tmp_path):
    store(beds, Cap(visible=[TRIANGLE]), Cap(visible=[SQUARE]), image=2)
    store(beds, Cap(visible=[SQUARE]), image=1)
    document = export(beds, out)
    assert [image["file_name"] for image in document["images"]] == ["bed_1.png", "bed_2.png"]
    assert [(a["id"], a["image_id"], a["uid"]) for a in document["annotations"]] == [
        (1, 1, "1_0"),
        (2, 2, "2_0"),
        (3, 2, "2_1"),
    ]
    assert [category["id"] for category in document["categories"]] == [1]
    export(beds, tmp_path / "again")
    assert (tmp_path / "again/instances.json").read_bytes() == (out / "instances.json").read_bytes()


def test_box_area_and_polygons_are_of_one_geometry(beds, out):
    store(beds, Cap(visible=[SQUARE, TRIANGLE]))
    (annotation,) = export(beds, out)["annotations"]
    assert annotation["segmentation"] == [SQUARE, TRIANGLE]
    assert annotation["bbox"] == [10, 10, 50, 50]
    assert annotation["area"] == 20 * 20 + 20 * 20 / 2
    assert annotation["iscrowd"] == 0
    assert "ignore" not in annotation


def test_a_marked_centre_is_visible_and_a_reconstructed_one_is_not(beds, out):
    store(beds, Cap(visible=[SQUARE], mark=Circle(20, 21, 11)), whole=Circle(20, 21, 11), centre=(20.0, 21.0))
    store(beds, Cap(visible=[SQUARE]), image=2, whole=Ellipse(19, 20, 12, 11, 30), centre=(19.0, 20.0))
    store(beds, Cap(visible=[SQUARE]), image=3)
    marked, worked_out, unknown = export(beds, out)["annotations"]
    assert (marked["center"], marked["circle"], marked["marked"]) == ([20, 21], [20, 21, 11], True)
    assert (marked["keypoints"], marked["num_keypoints"]) == ([19.5, 20.5, 2], 1)
    assert (worked_out["ellipse"], worked_out["marked"]) == ([19, 20, 12, 11, 30], False)
    assert worked_out["keypoints"] == [18.5, 19.5, 1]
    assert (unknown["center"], unknown["keypoints"], unknown["num_keypoints"]) == (None, [0, 0, 0], 0)


def test_the_whole_outline_and_how_much_is_hidden(beds, out):
    store(beds, Cap(visible=[SQUARE]), whole=Circle(20, 20, 20), centre=(20.0, 20.0))
    (annotation,) = export(beds, out)["annotations"]
    points = np.reshape(annotation["amodal_segmentation"][0], (-1, 2))
    assert np.hypot(*(points - 20).T) == pytest.approx(20, abs=1e-3)
    assert annotation["occlude_rate"] == pytest.approx(1 - 400 / (math.pi * 20**2), abs=0.01)


def test_a_circle_without_an_outline_is_drawn_within_a_tenth_of_a_pixel(beds, out):
    store(beds, Cap(visible=[], mark=Circle(50, 40, 30)))
    (annotation,) = export(beds, out)["annotations"]
    points = np.reshape(annotation["segmentation"][0], (-1, 2))
    chords = (points + np.roll(points, 1, axis=0)) / 2
    assert np.hypot(*(chords - (50, 40)).T).min() >= 30 - 0.1 - 1e-3
    assert annotation["segmentation_of"] == "mark"


def test_ignored_caps_stay_out_unless_they_are_asked_for(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE], ignored=True))
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_0"]
    kept = export(beds, tmp_path / "all", with_ignored=True)["annotations"]
    assert [(a["iscrowd"], a.get("ignored")) for a in kept] == [(0, None), (1, True)]


def test_deleted_caps_stay_out(beds, out):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE]))
    commit(beds, [Derived(edit=Edit(id="d", annotation="1_0", image=1, base=1, cap=None))], user="ann")
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_1"]


@pytest.fixture
def mixed(beds):
    """Image 1 annotated, image 2 approved and empty, image 3 predicted by the latest run alone."""

    def predict(connection, name, images):
        run = add_run(connection, name=name, kind="simulated")
        for image in images:
            new = [NewPrediction(visible=[TRIANGLE], score=0.5, whole=Circle(50, 46, 9), centre=(50.0, 46.0))]
            add_predictions(connection, run_id=run.id, image_id=image, predictions=new)

    store(beds, Cap(visible=[SQUARE]))
    beds.write(lambda c: predict(c, "early", [1, 2]))
    beds.write(lambda c: predict(c, "late", [3]))
    beds.write(lambda c: set_status(c, 2, "approved", user="ann"))
    return beds


@pytest.mark.parametrize(
    ("only", "files", "scores"),
    [
        ("annotated", ["bed_1.png", "bed_2.png"], [None]),
        ("approved", ["bed_2.png"], []),
        ("predicted", ["bed_10.png"], [0.5]),
        ("all", ["bed_1.png", "bed_2.png", "bed_10.png"], [None, 0.5]),
    ],
)
def test_what_is_exported_is_what_was_asked_for(mixed, out, only, files, scores):
    document = export(mixed, out, only=only)
    assert [image["file_name"] for image in document["images"]] == files
    assert [annotation.get("score") for annotation in document["annotations"]] == scores


def test_a_prediction_carries_its_score_centre_and_shape(mixed, out):
    document = export(mixed, out, only="predicted")
    (annotation,) = document["annotations"]
    assert (annotation["score"], annotation["center"], annotation["circle"]) == (0.5, [50, 46], [50, 46, 9])
    assert document["info"]["run"]["name"] == "late"


def test_predictions_exported_and_imported_again_are_the_same(mixed, out, tmp_path):
    export(mixed, out, only="predicted")
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out], as_="predictions")
        with other.read() as theirs, mixed.read() as ours:
            (mine,) = load_predictions(ours, 3)
            (copy,) = load_predictions(theirs, 1)
    assert (copy.visible, copy.score, copy.whole, copy.centre) == (mine.visible, 0.5, mine.whole, mine.centre)


@pytest.mark.parametrize("loader", [COCO, faster_coco_eval.COCO])
def test_others_load_it(beds, out, loader):
    store(beds, Cap(visible=[SQUARE, TRIANGLE]), Cap(visible=[], mark=Circle(50, 40, 9)))
    export(beds, out, with_ignored=True)
    coco = loader(str(out / "instances.json"))
    areas = [int(mask.area(coco.annToRLE(annotation))) for annotation in coco.loadAnns(coco.getAnnIds())]
    # A square of 20 px, half a box of 20 px, and a disc of 9 px.
    assert areas[0] == pytest.approx(600, abs=12)
    assert areas[1] == pytest.approx(math.pi * 81, abs=8)


def test_a_photo_turned_by_exif_is_written_upright(project, tmp_path, out):
    exif = Image.Exif()
    exif[0x0112] = 6
    pixels = np.zeros((40, 60, 3), np.uint8)
    pixels[:20, :30] = 255
    Image.fromarray(pixels).save(tmp_path / "turned.jpg", exif=exif, quality=95)
    import_paths(project, [tmp_path / "turned.jpg"])
    store(project, Cap(visible=[[22.0, 2.0, 38.0, 2.0, 38.0, 28.0, 22.0, 28.0]]))
    (image,) = export(project, out)["images"]
    assert (image["width"], image["height"]) == (40, 60)
    plain = cv2.imread(str(out / "images/turned.jpg"), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    assert plain.shape == (60, 40, 3)
    # Turned clockwise, the bright top left quarter lies at the top right, where the annotation is.
    assert plain[2:28, 22:38].min() > 230
    assert plain[:, :18].max() < 25
    with create_project(tmp_path / "other") as other:
        assert import_paths(other, [out]).problems == []


def test_a_folder_that_holds_something_is_refused_and_left_alone(beds, out):
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    with pytest.raises(StoreError, match="is not empty"):
        export_coco(beds, out)
    assert [file.name for file in out.iterdir()] == ["mine.txt"]


def test_an_empty_folder_is_filled(beds, out):
    out.mkdir()
    store(beds, Cap(visible=[SQUARE]))
    assert len(export(beds, out)["annotations"]) == 1


def test_an_export_that_fails_leaves_nothing_behind(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]))
    before = sorted(tmp_path.iterdir())

    def cancel(_done, _total, what):
        if what == "Writing labels":
            raise CancelledError

    with pytest.raises(CancelledError):
        export_coco(beds, out, progress=cancel)
    (beds.images / "bed_1.png").unlink()
    with pytest.raises(StoreError, match=r"bed_1\.png is gone; put the photo back"):
        export_coco(beds, out)
    assert sorted(tmp_path.iterdir()) == before


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
    assert document["annotations"][0]["id"] == 1
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
    commit(beds, [Derived(edit=edit, whole=Circle(20, 20, 14), centre=(20.0, 20.0))], user="ann")
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
    entries = [annotation_entry(a, number=n, image=1, category=1) for n, a in enumerate(annotations, start=1)]
    document = {
        "images": [{"id": 1, "file_name": "bed.png", "width": 100, "height": 80}],
        "categories": [{"id": 1, "name": "mushroom"}],
        "annotations": entries,
    }
    found = parse_coco(json.dumps(document).encode(), file="f.json")
    photo = Photo(file_name="bed.png", width=100, height=80, sha256="")
    fitted, problems = fit_caps(found.images[0].caps, photo=photo, file="f.json")
    assert found.problems == problems == []
    assert [cap.uid for cap in fitted] == [annotation.uid for annotation in annotations]
    return [cap.cap for cap in fitted]


@settings(max_examples=150, deadline=None)
@given(stored=st.lists(caps, min_size=1, max_size=3))
def test_a_cap_that_is_written_and_read_again_is_the_same(stored):
    """Coordinates to the fourth decimal, the second time exactly; the rest exactly."""
    once = written_and_read(stored)
    for mine, copy in zip(stored, once, strict=True):
        assert (copy.ignored, copy.doubtful, copy.order) == (mine.ignored, mine.doubtful, mine.order)
        assert type(copy.mark) is type(mine.mark)
        assert np.allclose(flat(copy), flat(mine), rtol=0, atol=6e-5)
    assert written_and_read(once) == once


def test_what_is_exported_and_imported_into_a_new_project_is_the_same(beds, out, tmp_path):
    """Of every kind of cap, through real files."""
    stored = [
        Cap(visible=[SQUARE, TRIANGLE], doubtful=True, order=2),
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


def flat(cap):
    shape = cap.mark
    numbers = [] if shape is None else shape.points if isinstance(shape, Polygon) else list(vars_of(shape))
    return [*numbers, *(coordinate for part in cap.visible for coordinate in part)]


def vars_of(shape):
    return (getattr(shape, name) for name in shape.__struct_fields__)
