"""Ids and categories stay as they came, and the same from export to export."""

import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.centre_figures import CapPairing, evaluate_centres
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Edit
from tests.support.exported import SQUARE, TRIANGLE, export, store

CATEGORIES = [{"id": 3, "name": "button", "supercategory": "fungus"}, {"id": 0, "name": "never seen"}]
IMAGES = [{"id": 285, "file_name": "b.png"}, {"id": 139, "file_name": "a.png"}]


def ids(entries, key="id"):
    return [entry[key] for entry in entries]


@pytest.fixture
def strangers(project, write_coco, write_photo, tmp_path):
    """A project of two photos and three caps that another tool has numbered."""
    for image in IMAGES:
        write_photo(tmp_path / "labels" / image["file_name"])
    entries = [
        {"id": 1768, "image_id": 285, "category_id": 3, "segmentation": [SQUARE]},
        {"id": 42, "image_id": 285, "category_id": 3, "segmentation": [TRIANGLE]},
        {"id": 1769, "image_id": 139, "category_id": 3, "segmentation": [SQUARE]},
    ]
    file = write_coco(entries, images=IMAGES, categories=CATEGORIES)
    assert import_paths(project, [file]).problems == []
    return project


def test_ids_and_categories_are_those_of_the_file_unused_ones_too(strangers, out):
    document = export(strangers, out)
    assert sorted(ids(document["images"])) == [139, 285]
    assert {entry["id"]: entry["image_id"] for entry in document["annotations"]} == {
        1768: 285,
        42: 285,
        1769: 139,
    }
    named = {entry["id"]: entry["name"] for entry in document["categories"]}
    assert named == {3: "button", 0: "never seen"}
    assert document["categories"][-1]["supercategory"] == "fungus"
    assert set(ids(document["annotations"], "category_id")) == {3}


def test_ids_stay_from_export_to_export_whatever_happens_in_between(strangers, out, tmp_path):
    before = {entry["uid"]: entry["id"] for entry in export(strangers, out)["annotations"]}
    gone = next(uid for uid, number in before.items() if number == 42)
    edit = Edit(id="e", annotation=gone, image=285, base=1, cap=None)
    commit(strangers, [Derived(edit=edit)], user="ann")
    store(strangers, Cap(visible=[[70.0, 50.0, 90.0, 50.0, 80.0, 70.0]]), image=139)
    after = {entry["uid"]: entry["id"] for entry in export(strangers, tmp_path / "again")["annotations"]}
    assert after.items() >= {uid: number for uid, number in before.items() if uid != gone}.items()
    assert after["139_0"] == 1770


def test_an_id_that_is_taken_or_cannot_be_one_gives_way_to_a_new_one(
    strangers, write_coco, write_photo, tmp_path
):
    photo = write_photo(tmp_path / "more" / "c.png")
    entries = [
        {"id": own, "image_id": 285, "segmentation": [[x, 50.0, x + 15, 50.0, x, 70.0]], "category_id": 3}
        for own, x in ((42, 5.0), (0, 25.0), (7, 45.0), (7, 65.0), (10**12, 80.0), ("seven", 3.0))
    ]
    images = [{"id": 285, "file_name": photo.name}]
    file = write_coco(entries, images=images, path=photo.with_suffix(".json"), categories=CATEGORIES)
    assert import_paths(strangers, [file]).annotations == 6
    document = export(strangers, tmp_path / "out")
    numbers = ids(document["annotations"])
    assert len(set(numbers)) == len(numbers) == 9
    assert sorted(numbers)[:3] == [7, 42, 1768]
    assert max(numbers) < 2000
    assert ids(document["images"]).count(285) == 1


def test_predictions_beside_annotations_have_ids_of_their_own(mixed, out):
    numbers = ids(export(mixed, out, only="all")["annotations"])
    assert len(set(numbers)) == len(numbers) == 2


def test_caps_are_paired_by_id_after_a_round_trip(strangers, out, tmp_path):
    truth = export(strangers, out)
    with create_project(tmp_path / "other") as other:
        import_paths(other, [out])
        said = export(other, tmp_path / "again")
    assert {e["uid"]: e["id"] for e in said["annotations"]} == {
        e["uid"]: e["id"] for e in truth["annotations"]
    }
    for document in (said, truth):
        for entry in document["annotations"]:
            entry["center"] = entry["bbox"][:2]
    figures = evaluate_centres(document_of(said), document_of(truth), CapPairing(by="id"))
    assert (figures["matched"], figures["missed"], figures["extra"]) == (3, 0, 0)
    assert figures["px"]["mean"] == 0
