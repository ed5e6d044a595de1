"""Caps that come back from elsewhere are recognised, never doubled, and taken over as somebody asks."""

import json

import pytest

from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.choices import KnownCaps
from fairyring.storage.images import get_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit, history
from fairyring.storage.records import Cap, Edit
from fairyring.storage.statuses import set_status
from tests.support.exported import export, store
from tests.support.imported import annotations_of, rows_of
from tests.support.other_tools import as_cvat, write_labelme
from tests.unit.storage.conftest import TRIANGLE

FAR = [[70.0, 10.0, 90.0, 10.0, 90.0, 30.0, 70.0, 30.0]]


def moved(outline, by):
    return [[x + by for x in part] for part in outline]


@pytest.fixture
def three(beds, write_coco, square):
    """A project with three caps in its first photo, and the file that they came from."""
    file = write_coco([{"segmentation": square}, {"segmentation": TRIANGLE}, {"segmentation": FAR}])
    assert import_paths(beds, [file]).annotations == 3
    return beds, file


def edited(file, change):
    """Changes a file as another program might."""
    document = json.loads(file.read_text())
    change(document["annotations"])
    file.write_text(json.dumps(document))
    return file


def outlines(project):
    return [annotation.cap.visible for annotation in annotations_of(project)]


def test_a_polygon_moved_by_two_pixels_is_told_and_makes_no_second_cap(three, square):
    beds, file = three
    before = rows_of(beds)
    edited(file, lambda caps: caps[0].update(segmentation=moved(square, 2)))
    report = import_paths(beds, [file])
    assert (report.annotations, report.known, report.changed, report.gone, report.edits) == (0, 3, 1, 0, 0)
    assert rows_of(beds) == before


def test_updating_takes_changes_as_edits_of_somebody(three, square):
    beds, file = three
    edited(file, lambda caps: (caps[0].update(segmentation=moved(square, 2)), caps.pop()))
    report = import_paths(beds, [file], known_caps=KnownCaps.update, user="Ada")
    assert (report.annotations, report.changed, report.gone, report.edits) == (0, 1, 1, 1)
    assert outlines(beds) == [moved(square, 2), TRIANGLE, FAR]
    first = annotations_of(beds)[0]
    with beds.read() as connection:
        (_, entry) = history(connection, first.uid)
    assert (entry.user, entry.revision, entry.before.visible) == ("Ada", 2, square)
    back = Edit(id="back", annotation=first.uid, image=1, base=2, cap=entry.before)
    commit(beds, [Derived(edit=back)], user="Bea")
    assert outlines(beds)[0] == square
    assert import_paths(beds, [file]).changed == 0, "what somebody undid is not new"


def test_replacing_deletes_what_the_file_lacks_and_brings_back_what_it_has(three, square):
    beds, file = three
    lost = annotations_of(beds)[1]
    commit(beds, [Derived(edit=Edit(id="d", annotation=lost.uid, image=1, base=1, cap=None))], user="Bea")
    edited(file, lambda caps: caps.pop())
    report = import_paths(beds, [file], known_caps=KnownCaps.replace)
    assert (report.gone, report.edits) == (1, 2)
    assert outlines(beds) == [square, TRIANGLE]
    assert import_paths(beds, [file], known_caps=KnownCaps.replace).edits == 0


def test_an_approved_image_is_so_no_longer_once_an_import_changes_it(three, square):
    beds, file = three
    beds.write(lambda connection: set_status(connection, 1, "approved", user="Ada"))
    assert import_paths(beds, [file]).known == 3
    assert status_of(beds) == "approved"
    edited(file, lambda caps: caps[0].update(segmentation=moved(square, 2)))
    import_paths(beds, [file], known_caps=KnownCaps.update)
    assert status_of(beds) == "annotated"


def status_of(project):
    with project.read() as connection:
        return get_image(connection, 1).status


def test_a_new_cap_beside_known_ones_is_taken_either_way(three):
    beds, file = three
    edited(file, lambda caps: caps.append(caps[0] | {"id": 9, "segmentation": moved(TRIANGLE, -30)}))
    assert import_paths(beds, [file], known_caps=KnownCaps.keep).annotations == 1
    assert len(outlines(beds)) == 4


def test_a_corrected_export_is_recognised_by_uid_however_far_a_cap_was_moved(three, out, square):
    beds, _ = three
    export(beds, out)
    edited(out / "instances.json", lambda caps: caps[0].update(segmentation=moved(square, 35)))
    assert import_paths(beds, [out], known_caps=KnownCaps.update).edits == 1
    assert outlines(beds)[0] == moved(square, 35)
    assert annotations_of(beds)[0].whole is None, "its whole outline is to be worked out anew"


def test_an_export_that_the_project_has_moved_on_from_changes_nothing_back(three, out, square):
    beds, _ = three
    export(beds, out)
    uid = annotations_of(beds)[0].uid
    later = Edit(id="later", annotation=uid, image=1, base=1, cap=Cap(visible=moved(square, 3)))
    commit(beds, [Derived(edit=later)], user="Bea")
    report = import_paths(beds, [out], known_caps=KnownCaps.update)
    assert (report.changed, report.edits) == (0, 0)
    assert outlines(beds)[0] == moved(square, 3)


def test_a_round_trip_through_cvat_changes_what_was_changed_there(beds, out, tmp_path):
    store(
        beds,
        Cap(visible=[[10.123, 10.0, 30.0, 10.456, 30.0, 30.0, 10.0, 30.789]], doubtful=True, order=2),
        Cap(visible=TRIANGLE, mark=Circle(50.25, 46.5, 11.5)),
        Cap(visible=[], mark=Circle(80.5, 20.25, 9.125)),
    )
    file = tmp_path / "cvat.json"
    document = as_cvat(export(beds, out))
    file.write_text(json.dumps(document))
    before = rows_of(beds)
    report = import_paths(beds, [file], known_caps=KnownCaps.replace)
    assert (report.annotations, report.known, report.changed, report.gone) == (0, 3, 0, 0)
    assert report.problems == []
    assert rows_of(beds)["annotation"] == before["annotation"]

    edited(file, lambda caps: caps[1].update(segmentation=moved(TRIANGLE, 1.5)))
    assert import_paths(beds, [file], known_caps=KnownCaps.update).edits == 1
    first, second, third = annotations_of(beds)
    assert (first.cap.doubtful, first.cap.order, third.cap.visible) == (True, 2, [])
    assert (second.cap.visible, second.cap.mark) == (moved(TRIANGLE, 1.5), Circle(50.25, 46.5, 11.5))


def test_a_round_trip_through_labelme_changes_what_was_changed_there(beds, out, tmp_path):
    store(beds, Cap(visible=[*TRIANGLE, *FAR]), Cap(visible=moved(TRIANGLE, -25), mark=Circle(25, 20, 9)))
    document = export(beds, out)
    (file,) = write_labelme(document, tmp_path / "labelme")
    assert import_paths(beds, [file]).changed == 0

    def drag(nth, points):
        return [[points[0][0] + 2, points[0][1]], *points[1:]] if nth == 1 else points

    (file,) = write_labelme(document, tmp_path / "labelme", moved=drag)
    report = import_paths(beds, [file], known_caps=KnownCaps.update)
    assert (report.annotations, report.known, report.changed, report.edits) == (0, 2, 1, 1)
    first, second = annotations_of(beds)
    assert (first.revision, second.revision) == (1, 2)
    assert (second.cap.visible[0][:2], second.cap.mark) == ([17.0, 15.0], Circle(25, 20, 9))


def test_a_mark_drawn_elsewhere_is_that_of_the_cap_it_lies_on(three, tmp_path):
    beds, _ = three
    circle = {"label": "mushroom", "shape_type": "circle", "points": [[20, 20], [20, 31]]}
    file = tmp_path / "bed_1.json"
    file.write_text(json.dumps({"shapes": [circle], "imagePath": "bed_1.png"}))
    report = import_paths(beds, [file], known_caps=KnownCaps.update)
    assert (report.annotations, report.edits, report.gone) == (0, 1, 2)
    first = annotations_of(beds)[0]
    assert (first.cap.mark, len(first.cap.visible[0])) == (Circle(20, 20, 11), 8)


def test_ignored_caps_that_exports_leave_out_are_not_gone(beds, out, square):
    store(beds, Cap(visible=square), Cap(visible=TRIANGLE, ignored=True))
    export(beds, out)
    report = import_paths(beds, [out], known_caps=KnownCaps.replace)
    assert (report.known, report.gone, report.edits) == (1, 0, 0)


def test_masks_of_the_same_pixels_are_the_same_cap(three):
    beds, file = three

    def as_masks(caps):
        for cap in caps:
            cap["segmentation"] = dict(rle_of_outline(cap["segmentation"], width=100, height=80))

    report = import_paths(beds, [edited(file, as_masks)])
    assert (report.known, report.changed) == (3, 0)


def test_two_files_that_say_the_same_of_a_new_photo_make_one_cap(
    project, write_coco, write_photo, tmp_path, square
):
    photo = write_photo(tmp_path / "labels" / "bed_1.png")
    coco = write_coco([{"segmentation": square}])
    points = [[10.2, 10.1], [30, 10], [30, 30], [10, 30]]
    document = {"shapes": [{"label": "mushroom", "points": points}], "imagePath": photo.name}
    (photo.parent / "z.json").write_text(json.dumps(document))
    report = import_paths(project, [coco.parent])
    assert (report.annotations, report.known) == (1, 1)


def test_two_caps_of_one_file_that_overlap_are_two(beds, write_coco, square):
    file = write_coco([{"segmentation": square}, {"segmentation": moved(square, 0.5)}])
    assert import_paths(beds, [file]).annotations == 2
    assert import_paths(beds, [file]).known == 2


def test_a_cap_that_a_tool_has_copied_with_all_its_keys_is_another_cap(beds, write_coco, square):
    other = [[x + 40 for x in square[0]]]
    entries = [
        {"segmentation": square, "uid": "one", "id": 5},
        {"segmentation": other, "uid": "one", "id": 5},
    ]
    assert import_paths(beds, [write_coco(entries)]).annotations == 2
    again = import_paths(beds, [write_coco(entries)])
    assert (again.annotations, again.known, again.changed) == (0, 2, 0)


def test_a_cap_that_somebody_deleted_stays_so_whatever_another_tool_calls_it(three, out, tmp_path):
    beds, _ = three
    (first, *_) = annotations_of(beds)
    changed = Cap(visible=moved(first.cap.visible, 2), mark=Circle(30, 40, 12))
    edit = Edit(id="moved", annotation=first.uid, image=1, base=1, cap=changed)
    commit(beds, [Derived(edit=edit)], user="ann")
    elsewhere = as_cvat(export(beds, out, only="all"))
    commit(
        beds,
        [Derived(edit=Edit(id="gone", annotation=first.uid, image=1, base=2, cap=None))],
        user="ann",
    )
    file = tmp_path / "back" / "cvat.json"
    file.parent.mkdir()
    file.write_text(json.dumps(elsewhere))
    report = import_paths(beds, [file], known_caps=KnownCaps.update)
    assert (report.annotations, report.known, report.edits) == (0, 3, 0)
    assert len(outlines(beds)) == 2
    report = import_paths(beds, [file], known_caps=KnownCaps.replace)
    assert (report.annotations, report.edits) == (0, 1)
    (back,) = [each for each in annotations_of(beds) if each.uid == first.uid]
    assert back.cap == changed


def test_a_cap_counts_again_and_is_sure_again_where_a_file_says_so(beds, out, square):
    store(beds, Cap(visible=square, ignored=True, doubtful=True))
    document = export(beds, out, with_ignored=True)
    (entry,) = document["annotations"]
    assert (entry["iscrowd"], entry["ignored"], entry["doubt"]) == (1, True, True)
    for key in ("ignored", "doubt"):
        del entry[key]
    entry["iscrowd"] = 0
    (out / "instances.json").write_text(json.dumps(document))
    assert import_paths(beds, [out / "instances.json"]).changed == 1
    assert import_paths(beds, [out / "instances.json"], known_caps=KnownCaps.update).edits == 1
    (annotation,) = annotations_of(beds)
    assert (annotation.cap.ignored, annotation.cap.doubtful) == (False, False)


def test_a_file_that_does_not_know_of_doubt_leaves_it(beds, square, write_coco):
    store(beds, Cap(visible=square, doubtful=True))
    file = write_coco([{"segmentation": square}])
    assert import_paths(beds, [file], known_caps=KnownCaps.update).edits == 0
