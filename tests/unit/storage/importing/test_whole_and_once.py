"""An import is stored as a whole or not at all, once, and in the journal."""

import shutil
from concurrent.futures import CancelledError

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.importing.staging import Staging
from fairyring.storage.journal import Derived, commit, history
from fairyring.storage.records import Cap, Edit
from tests.support.imported import annotations_of, files_of, rows_of
from tests.unit.storage.conftest import TRIANGLE


def test_strict_takes_nothing_if_anything_is_wrong(project, tmp_path, write_photo):
    write_photo(tmp_path / "in" / "good.png")
    (tmp_path / "in" / "bad.png").write_text("no")
    before = rows_of(project)
    with pytest.raises(StoreError, match=r"Nothing was imported, as asked: .*bad\.png"):
        import_paths(project, [tmp_path / "in"], strict=True)
    assert rows_of(project) == before
    assert files_of(project) == []


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


def test_photos_moved_in_before_a_commit_that_fails_are_removed(project, tmp_path, write_photo, monkeypatch):
    photo = write_photo(tmp_path / "bed.png")
    move_in = Staging.move_in

    def move_in_and_fail(self):
        move_in(self)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Staging, "move_in", move_in_and_fail)
    before = rows_of(project)
    with pytest.raises(StoreError, match="images cannot be written: No space left on device"):
        import_paths(project, [photo])
    assert rows_of(project) == before
    assert files_of(project) == []


def test_the_same_photos_again_add_nothing(beds, tmp_path, write_photo):
    before = rows_of(beds)
    report = import_paths(beds, [write_photo(tmp_path / "again" / "bed_1.png")])
    assert (report.images, report.images_known) == (0, 1)
    assert rows_of(beds) == before


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
