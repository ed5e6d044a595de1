import json
import math
import shutil
import sqlite3
from concurrent.futures import CancelledError

import cv2
import numpy as np
import pytest
from PIL import Image

from model.geometry import Circle, Ellipse, Polygon
from storage.documents import load_annotations, load_document, load_predictions, load_run
from storage.errors import StoreError
from storage.images import ImageFilter, find_image, list_images
from storage.importing import import_paths
from storage.journal import Derived, commit, history
from storage.records import Cap, Edit

TRIANGLE = [[40.0, 40.0, 60.0, 40.0, 50.0, 60.0]]


def rows_of(project):
    """Every row of every table, to see that nothing was changed."""
    with sqlite3.connect(project.folder / "project.db") as connection:
        tables = [
            name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        ]
        return {table: connection.execute(f"SELECT * FROM {table}").fetchall() for table in tables}


def files_of(project):
    return sorted(str(file.relative_to(project.images)) for file in project.images.rglob("*"))


def annotations_of(project, image=1):
    with project.read() as connection:
        return load_annotations(connection, image)


def reasons(report):
    return [problem.reason for problem in report.problems]


# Photos


def test_photos_are_copied_with_size_hash_and_what_was_said_of_them(project, tmp_path, write_photo):
    photo = write_photo(tmp_path / "in" / "Bed 1.PNG", width=64, height=48)
    report = import_paths(project, [photo], light="side", form="c")
    assert (report.images, report.images_known, report.problems) == (1, 0, [])
    with project.read() as connection:
        image = find_image(connection, "Bed 1.PNG")
    assert (image.width, image.height, image.light, image.form, image.status) == (64, 48, "side", "c", "new")
    assert image.path == "images/Bed 1.PNG"
    assert (project.folder / image.path).read_bytes() == photo.read_bytes()


def test_photos_can_stay_where_they_are(project, tmp_path, write_photo):
    photo = write_photo(tmp_path / "in" / "bed.png")
    import_paths(project, [photo], link=True)
    with project.read() as connection:
        assert find_image(connection, "bed.png").path == str(photo)
    assert files_of(project) == []


def test_a_folder_is_searched_to_the_bottom(project, tmp_path, write_photo):
    folder = tmp_path / "in"
    for name in ("b.png", "day 2/a.jpg", ".hidden.png", ".git/c.png"):
        write_photo(folder / name)
    (folder / "notes.txt").write_text("rain")
    (folder / "link.png").symlink_to(folder / "b.png")
    assert import_paths(project, [folder]).images == 2
    assert files_of(project) == ["a.jpg", "b.png"]


def test_the_same_photos_again_add_nothing(beds, tmp_path, write_photo):
    before = rows_of(beds)
    report = import_paths(beds, [write_photo(tmp_path / "again" / "bed_1.png")])
    assert (report.images, report.images_known) == (0, 1)
    assert rows_of(beds) == before


def test_a_second_photo_of_the_same_name_is_reported(beds, tmp_path, write_photo):
    other = write_photo(tmp_path / "other" / "bed_1.png", seed=5)
    good = write_photo(tmp_path / "other" / "good.png")
    report = import_paths(beds, [other, good])
    assert report.images == 1
    assert reasons(report) == ["Another image is called bed_1.png already; rename one of them."]


def test_bad_photos_are_reported_by_name_and_the_good_ones_taken(project, tmp_path, write_photo):
    folder = tmp_path / "in"
    whole = write_photo(folder / "good.jpg")
    (folder / "broken.jpg").write_bytes(whole.read_bytes()[:700])
    (folder / "empty.jpg").write_bytes(b"")
    (folder / "text.jpg").write_text("not a photo")
    report = import_paths(project, [folder])
    assert report.images == 1
    assert sorted(problem.file.rsplit("/", 1)[-1] for problem in report.problems) == [
        "broken.jpg",
        "empty.jpg",
        "text.jpg",
    ]
    assert files_of(project) == ["good.jpg"]


def test_strict_takes_nothing_if_anything_is_wrong(project, tmp_path, write_photo):
    write_photo(tmp_path / "in" / "good.png")
    (tmp_path / "in" / "bad.png").write_text("no")
    before = rows_of(project)
    with pytest.raises(StoreError, match=r"Nothing was imported, as asked: .*bad\.png"):
        import_paths(project, [tmp_path / "in"], strict=True)
    assert rows_of(project) == before
    assert files_of(project) == []


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("nowhere", "does not exist"),
        ("beds.zip", "is an archive; unpack it"),
        ("empty", "no photo or file of labels"),
    ],
)
def test_paths_that_hold_nothing_are_refused(project, tmp_path, name, reason):
    (tmp_path / "empty").mkdir()
    (tmp_path / "beds.zip").write_bytes(b"PK")
    with pytest.raises(StoreError, match=reason):
        import_paths(project, [tmp_path / name])


def test_an_exif_rotated_photo_is_upright_in_the_project(project, tmp_path):
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("RGB", (60, 40)).save(tmp_path / "turned.jpg", exif=exif)
    import_paths(project, [tmp_path / "turned.jpg"])
    with project.read() as connection:
        image = find_image(connection, "turned.jpg")
    assert (image.width, image.height) == (40, 60)


def test_a_photo_lying_in_the_project_already_is_taken_where_it_lies(project, write_photo):
    write_photo(project.images / "bed.png")
    assert import_paths(project, [project.images]).images == 1
    assert files_of(project) == ["bed.png"]


def test_a_strange_file_in_the_way_is_not_overwritten(project, tmp_path, write_photo):
    stranger = write_photo(project.images / "bed.png", seed=9)
    content = stranger.read_bytes()
    with pytest.raises(StoreError, match="is in the way of"):
        import_paths(project, [write_photo(tmp_path / "bed.png")])
    assert stranger.read_bytes() == content


# COCO


def test_coco_annotations_find_their_image_by_base_name_and_size(beds, write_coco, square):
    images = [{"id": 7, "file_name": "C:\\somewhere\\bed_2.png", "width": 100, "height": 80}]
    file = write_coco([{"image_id": 7, "segmentation": square, "source": "hand"}], images=images)
    report = import_paths(beds, [file])
    assert (report.images, report.images_known, report.annotations, report.problems) == (0, 1, 1, [])
    (annotation,) = annotations_of(beds, image=2)
    assert (annotation.cap, annotation.revision) == (Cap(visible=square), 1)
    assert annotation.extra == {"source": "hand"}
    assert (annotation.whole, annotation.centre) == (None, None)


@pytest.mark.parametrize("place", ["bed_9.png", "images/bed_9.png"])
def test_a_photo_beside_the_file_is_taken_along(project, tmp_path, write_coco, write_photo, place):
    write_photo(tmp_path / "labels" / place)
    images = [
        {"id": 1, "file_name": "deep/down/bed_9.png", "width": 100, "height": 80, "light": "dark", "x": 1}
    ]
    report = import_paths(
        project, [write_coco([{"segmentation": TRIANGLE}], images=images)], light="top", form="b"
    )
    assert (report.images, report.annotations) == (1, 1)
    with project.read() as connection:
        image = find_image(connection, "bed_9.png")
    assert (image.light, image.form, image.extra) == ("dark", "b", {"x": 1})


def test_what_a_file_says_of_a_known_photo_fills_gaps_and_changes_nothing(beds, write_coco):
    def say(light, split):
        image = {"id": 1, "file_name": "bed_1.png", "light": light, "split": split, "camera": split}
        import_paths(beds, [write_coco([], images=[image])])
        with beds.read() as connection:
            return find_image(connection, "bed_1.png")

    first = say("dark", "train")
    assert (first.light, first.split, first.extra) == ("dark", "train", {"camera": "train"})
    assert say("top", "test") == first


@pytest.mark.parametrize("name", ["missing.png", "../secret.png", "/etc/secret.png"])
def test_an_image_that_is_nowhere_is_reported(beds, tmp_path, write_coco, write_photo, name):
    write_photo(tmp_path / "secret.png")
    images = [{"id": 1, "file_name": "bed_1.png"}, {"id": 2, "file_name": name}]
    report = import_paths(beds, [write_coco([{"segmentation": TRIANGLE}], images=images)])
    assert report.annotations == 1
    assert "is neither in the project nor beside this file" in reasons(report)[0]


def test_a_symbolic_link_beside_the_file_is_refused(project, tmp_path, write_coco, write_photo, square):
    secret = write_photo(tmp_path / "secret.png")
    file = write_coco([{"segmentation": square}])
    (file.parent / "bed_1.png").symlink_to(secret)
    with pytest.raises(StoreError, match="is a symbolic link"):
        import_paths(project, [file])


def test_a_size_that_differs_is_reported_in_figures(beds, write_coco, square):
    images = [{"id": 1, "file_name": "bed_1.png", "width": 80, "height": 100}]
    with pytest.raises(StoreError, match="100 × 80 pixels when upright, but this file says 80 × 100"):
        import_paths(beds, [write_coco([{"segmentation": square}], images=images)])


def test_importing_the_same_again_adds_nothing(beds, write_coco, square):
    file = write_coco([{"segmentation": square}, {"segmentation": TRIANGLE, "circle": [50, 46, 9]}])
    assert import_paths(beds, [file]).annotations == 2
    before = rows_of(beds)
    report = import_paths(beds, [file])
    assert (report.annotations, report.known) == (0, 2)
    assert rows_of(beds) == before


def test_two_copies_of_a_photo_with_the_same_labels_keep_them_both(
    project, write_photo, write_coco, square, tmp_path
):
    first = write_photo(tmp_path / "in" / "a.png")
    second = first.with_name("b.png")
    shutil.copy(first, second)
    images = [{"id": n, "file_name": p.name} for n, p in enumerate((first, second), start=1)]
    file = write_coco([{"segmentation": square, "image_id": n} for n in (1, 2)], images=images)
    assert import_paths(project, [first, second, file]).annotations == 2
    assert [len(annotations_of(project, image)) for image in (1, 2)] == [1, 1]


def test_importing_again_does_not_bring_back_what_somebody_deleted_or_changed(beds, write_coco, square):
    file = write_coco([{"segmentation": square}, {"segmentation": TRIANGLE}])
    import_paths(beds, [file])
    first, second = annotations_of(beds)

    def edit(uid, cap):
        return Derived(edit=Edit(id=uid, annotation=uid, image=1, base=1, cap=cap))

    changed = Cap(visible=[[1.0, 1.0, 9.0, 1.0, 9.0, 9.0]])
    commit(beds, [edit(first.uid, None), edit(second.uid, changed)], user="ann")
    assert import_paths(beds, [file]).known == 2
    assert [annotation.cap for annotation in annotations_of(beds)] == [changed]


def test_the_journal_names_the_import(beds, write_coco, square):
    import_paths(beds, [write_coco([{"segmentation": square}])])
    (annotation,) = annotations_of(beds)
    with beds.read() as connection:
        (entry,) = history(connection, annotation.uid)
    assert (entry.user, entry.revision, entry.before, entry.after) == ("import", 1, None, annotation.cap)


def test_an_imported_annotation_can_be_edited(beds, write_coco, square):
    import_paths(beds, [write_coco([{"segmentation": square}])])
    (annotation,) = annotations_of(beds)
    edit = Edit(id="e", annotation=annotation.uid, image=1, base=1, cap=Cap(visible=TRIANGLE))
    (outcome,) = commit(beds, [Derived(edit=edit)], user="ann")
    assert outcome.annotation.revision == 2


def test_marks_become_whole_outlines_at_once(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "circle": [20, 20, 11]},
            {"segmentation": TRIANGLE, "ellipse": [50, 46, 9, 8, 5], "center": [50, 46]},
            {"segmentation": [], "circle": [70, 60, 5]},
            {"segmentation": [[1, 1, 9, 1, 9, 9, 1, 9]], "center": [5.5, 5]},
        ]
    )
    report = import_paths(beds, [file])
    assert report.problems == []
    circle, ellipse, unseen, centre = annotations_of(beds)
    assert (circle.cap.mark, circle.whole, circle.centre) == (
        Circle(20, 20, 11),
        Circle(20, 20, 11),
        (20, 20),
    )
    assert ellipse.cap.mark == ellipse.whole == Ellipse(50, 46, 9, 8, 5)
    assert (unseen.cap.visible, unseen.cap.mark) == ([], Circle(70, 60, 5))
    # A square of 8 × 8 has the area of a circle of radius 8/√π.
    assert centre.cap.mark == Circle(5.5, 5.0, pytest.approx(8 / math.sqrt(math.pi)))


def test_a_center_beside_its_circle_is_reported(beds, write_coco, square):
    file = write_coco([{"segmentation": square, "circle": [20, 20, 11], "center": [23, 24]}])
    report = import_paths(beds, [file])
    assert report.annotations == 1
    assert reasons(report) == ["Its center lies 5.0 px from that of its circle or ellipse, which was taken."]


BAD_OUTLINES = [
    [[10, 10, 20, 20]],
    [[10, 10, 20, 20, 30]],
    [[10, 10, 20, 10, math.nan, 20]],
    [[10, 10, 20, 10, math.inf, 20]],
    [[10, 10, 20, 10, 1e30, 20]],
    [[10, 10, 20, 10, True, 20]],
    [[10, 10, 20, 10, "15", 20]],
    [[10, 10, 20, 20, 30, 30]],
    [[500, 500, 510, 500, 505, 510]],
    [[]],
    [],
    {"size": [81, 100], "counts": [0, 8100]},
]


@pytest.mark.parametrize("outline", BAD_OUTLINES, ids=str)
def test_an_outline_that_cannot_be_used_is_reported_and_the_others_taken(beds, write_coco, square, outline):
    report = import_paths(beds, [write_coco([{"segmentation": outline}, {"segmentation": square}])])
    assert report.annotations == 1
    (problem,) = report.problems
    assert problem.where == "annotation 1"
    assert annotations_of(beds)[0].cap.visible == square


def test_a_bad_part_is_left_out_and_the_rest_of_the_cap_kept(beds, write_coco, square):
    report = import_paths(beds, [write_coco([{"segmentation": [*square, [1, 1, 2, 2]]}])])
    assert annotations_of(beds)[0].cap.visible == square
    assert reasons(report) == ["Part 2 was left out: A polygon needs at least three points."]


def test_categories_are_made_as_they_come(beds, write_coco, square):
    categories = [{"id": 1, "name": "mushroom"}, {"id": 5, "name": "button", "supercategory": "fungus"}]
    file = write_coco([{"segmentation": square, "category_id": 5}], categories=categories)
    import_paths(beds, [file])
    assert annotations_of(beds)[0].cap.category == "button"


def test_an_import_that_is_cancelled_changes_nothing(project, tmp_path, write_coco, write_photo, square):
    write_photo(tmp_path / "labels" / "bed_1.png")
    file = write_coco([{"segmentation": square}])
    before = rows_of(project)
    for step in ("Reading", "Checking", "Copying photos", "Storing"):

        def cancel(_done, _total, what, step=step):
            if what == step:
                raise CancelledError

        with pytest.raises(CancelledError):
            import_paths(project, [file], progress=cancel)
        assert rows_of(project) == before
        assert files_of(project) == []
    assert import_paths(project, [file]).annotations == 1


def test_photos_placed_before_a_commit_that_fails_are_removed(project, tmp_path, write_photo, monkeypatch):
    from storage import placing

    def fail(_path):
        raise OSError(28, "No space left on device")

    photo = write_photo(tmp_path / "bed.png")
    place = placing.Staging.place

    def place_and_fail(self):
        place(self)
        fail(None)

    monkeypatch.setattr(placing.Staging, "place", place_and_fail)
    before = rows_of(project)
    with pytest.raises(OSError, match="No space left"):
        import_paths(project, [photo])
    assert rows_of(project) == before
    assert files_of(project) == []


# Predictions


def test_a_file_taken_as_predictions_is_a_run(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "score": 0.75, "ellipse": [20, 20, 10, 9, 0], "center": [20.5, 20]},
            {"segmentation": TRIANGLE},
        ]
    )
    report = import_paths(beds, [file], as_="predictions")
    assert (report.annotations, report.predictions) == (0, 2)
    with beds.read() as connection:
        first, second = load_predictions(connection, 1)
        run = load_run(connection, report.run)
        assert load_annotations(connection, 1) == []
    assert (first.score, first.whole, first.centre) == (0.75, Ellipse(20, 20, 10, 9, 0), (20.5, 20.0))
    assert (second.score, second.whole) == (1.0, None)
    assert (run.name, run.kind) == ("labels.json", "import")


def test_the_same_predictions_again_add_nothing(beds, write_coco, square):
    file = write_coco([{"segmentation": square, "score": 0.5}])
    first = import_paths(beds, [file], as_="predictions")
    again = import_paths(beds, [file], as_="predictions")
    assert (again.predictions, again.known, again.run) == (0, 1, first.run)


def test_what_cannot_be_a_prediction_is_reported(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "score": 0.5},
            {"segmentation": TRIANGLE, "ignore": True},
            {"segmentation": TRIANGLE, "score": 50},
        ]
    )
    report = import_paths(beds, [file], as_="predictions")
    assert report.predictions == 1
    assert [problem.where for problem in report.problems] == ["annotation 2", "annotation 3"]


def test_a_prediction_that_is_only_a_circle_is_seen_as_that_circle(beds, write_coco):
    import_paths(
        beds, [write_coco([{"segmentation": [], "circle": [50, 40, 20], "score": 0.5}])], as_="predictions"
    )
    with beds.read() as connection:
        (prediction,) = load_document(connection, 1).predictions
    points = np.reshape(prediction.visible[0], (-1, 2))
    assert np.hypot(*(points - (50, 40)).T) == pytest.approx(20)


# labelme


def test_a_folder_of_labelme_files_and_photos(project, tmp_path, write_photo):
    folder = tmp_path / "labelled"
    for name in ("a", "b"):
        write_photo(folder / f"{name}.png")
        shapes = [
            {"label": "mushroom", "points": [[10, 10], [30, 10], [20, 30]], "shape_type": "polygon"},
            {"label": "mushroom", "points": [[50, 50], [50, 58]], "shape_type": "circle"},
        ]
        document = {"shapes": shapes, "imagePath": f"..\\x\\{name}.png", "imageHeight": 80, "imageWidth": 100}
        (folder / f"{name}.json").write_text(json.dumps(document))
    report = import_paths(project, [folder])
    assert (report.images, report.annotations, report.problems) == (2, 4, [])
    outlined, marked = annotations_of(project, image=2)
    assert outlined.cap.mark == Polygon(outlined.cap.visible[0])
    assert (marked.cap.visible, marked.cap.mark, marked.whole) == ([], Circle(50, 50, 8), Circle(50, 50, 8))
    assert import_paths(project, [folder]).known == 4


def test_the_format_can_be_said(beds, write_coco, square, tmp_path):
    file = write_coco([{"segmentation": square}])
    with pytest.raises(StoreError, match="is not a labelme file"):
        import_paths(beds, [file], kind="labelme")
    named = shutil.copy(file, tmp_path / "labels.txt")
    assert import_paths(beds, [tmp_path / "labels.txt"], kind="coco").annotations == 1
    assert named.exists()


def test_an_import_of_images_leaves_labels_alone(project, write_coco, write_photo, square):
    file = write_coco([{"segmentation": square}])
    write_photo(file.parent / "bed_1.png")
    report = import_paths(project, [file.parent], kind="images")
    assert (report.images, report.annotations) == (1, 0)


def test_the_counters_follow_an_import(beds, write_coco, square):
    import_paths(beds, [write_coco([{"segmentation": square}, {"segmentation": TRIANGLE, "ignore": True}])])
    with beds.read() as connection:
        row = list_images(connection, ImageFilter(search="bed_1.png")).rows[0]
    assert (row.caps, row.ignored) == (1, 1)


def test_a_16_bit_photo_is_taken(project, tmp_path):
    cv2.imwrite(str(tmp_path / "deep.png"), np.full((20, 30), 40000, np.uint16))
    assert import_paths(project, [tmp_path / "deep.png"]).images == 1
