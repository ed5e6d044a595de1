"""Images taken out of a project, put back as they were, or let go."""

import pytest

from fairyring.storage.compared_caps import CapFigures
from fairyring.storage.comparisons import Comparison, store_comparison
from fairyring.storage.contents import load_version
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ImageFilter, find_image, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Edit
from fairyring.storage.statuses import set_status
from fairyring.storage.taken_out import let_go, put_back, take_out, taken_out
from tests.support.exported import SQUARE, TRIANGLE, store
from tests.support.imported import files_of, rows_of

APART = ("image", "sqlite_sequence", "sqlite_stat1", "sqlite_stat4")


@pytest.fixture
def worked_on(beds):
    """Three images; the first has predictions, two caps, one edited twice, is compared and approved."""

    def predict(connection):
        run = add_run(connection, name="lite0", kind="simulated")
        add_predictions(
            connection,
            run_id=run.id,
            image_id=1,
            predictions=[NewPrediction(visible=[SQUARE], score=0.5, uid="p")],
        )

    beds.write(predict)
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE]))
    store(beds, Cap(visible=[SQUARE]), image=2)
    figures = Comparison(image=1, run=1, version=0, caps=2, marked=0, matched=1, missed=1, extra=0)
    caps = [CapFigures(image=1, run=1, annotation="a", prediction=each, size="s") for each in (1, None)]
    beds.write(lambda connection: store_comparison(connection, figures, caps=caps))
    beds.write(lambda connection: set_status(connection, 1, "approved", user="ann"))
    return beds


def without_versions(rows):
    """Versions only ever grow; nothing else may differ. The last column of an image is its version."""
    rows = {
        table: sorted(map(repr, found)) for table, found in rows.items() if not table.startswith("sqlite_")
    }
    return {table: found for table, found in rows.items() if table != "image"}


def listed(project):
    with project.read() as connection:
        return list_images(connection, ImageFilter()).rows


def version_of(project, image):
    with project.read() as connection:
        return load_version(connection, image)


def test_an_image_is_taken_out_with_all_that_is_of_it(worked_on):
    (taken,) = take_out(worked_on, [1], user="ann")
    assert (taken.file_name, taken.caps) == ("bed_1.png", 2)
    rows = rows_of(worked_on)
    assert [row[1] for row in rows["image"]] == ["bed_2.png", "bed_10.png"]
    assert (len(rows["annotation"]), len(rows["prediction"]), len(rows["status_change"])) == (1, 0, 0)
    assert len(rows["edit"]) == 1
    assert (rows["compared_cap"], rows["compared_class"]) == ([], [])
    assert files_of(worked_on) == ["bed_10.png", "bed_2.png"]


def test_put_back_it_is_as_it_was(worked_on):
    before, photo = rows_of(worked_on), (worked_on.images / "bed_1.png").read_bytes()
    images, version = listed(worked_on), version_of(worked_on, 1)
    take_out(worked_on, [1, 3], user="ann")
    kept = taken_out(worked_on)
    assert {each.file_name for each in kept} == {"bed_1.png", "bed_10.png"}
    put_back(worked_on, kept)
    after = rows_of(worked_on)
    assert without_versions(after) == without_versions(before)
    assert listed(worked_on) == images
    assert version_of(worked_on, 1) > version
    assert (worked_on.images / "bed_1.png").read_bytes() == photo
    assert taken_out(worked_on) == []


def test_what_was_put_back_can_be_edited_and_taken_out_again(worked_on):
    for _ in range(2):
        take_out(worked_on, [1], user="ann")
        put_back(worked_on, taken_out(worked_on))
    store(worked_on, Cap(visible=[SQUARE]), image=3)
    assert len(rows_of(worked_on)["annotation"]) == 4


def test_an_image_that_took_its_name_is_in_the_way(worked_on, tmp_path, write_photo):
    take_out(worked_on, [1], user="ann")
    import_paths(worked_on, [write_photo(tmp_path / "new" / "bed_1.png", seed=7)])
    before = rows_of(worked_on)
    with pytest.raises(StoreError, match=r"Another image is called bed_1\.png now"):
        put_back(worked_on, taken_out(worked_on))
    assert rows_of(worked_on) == before
    assert len(taken_out(worked_on)) == 1


def test_an_import_gives_no_number_that_was_taken_out(worked_on, tmp_path, write_photo, write_coco):
    before = rows_of(worked_on)
    take_out(worked_on, [1], user="ann")
    write_photo(tmp_path / "labels" / "bed_4.png", seed=7)
    images = [{"id": 1, "file_name": "bed_4.png"}]
    import_paths(worked_on, [write_coco([{"id": 1, "segmentation": [TRIANGLE]}], images=images)])
    entered = rows_of(worked_on)
    assert [row[0] for row in entered["image"]] == [2, 3, 4]
    assert [row[0] for row in entered["annotation"]] == [3, 4]
    put_back(worked_on, taken_out(worked_on))
    after = rows_of(worked_on)
    assert after["prediction"] == before["prediction"]
    for table in ("annotation", "edit"):
        assert set(map(repr, before[table])) < set(map(repr, after[table]))


def test_several_of_one_name_are_kept_apart(worked_on, tmp_path, write_photo):
    first = (worked_on.images / "bed_1.png").read_bytes()
    take_out(worked_on, [1], user="ann")
    other = write_photo(tmp_path / "new" / "bed_1.png", seed=7)
    import_paths(worked_on, [other])
    with worked_on.read() as connection:
        image = find_image(connection, "bed_1.png")
    assert image is not None
    number = image.id
    take_out(worked_on, [number], user="ann")
    kept = taken_out(worked_on)
    assert {each.number for each in kept} == {1, number}
    put_back(worked_on, [each for each in kept if each.number == 1])
    assert (worked_on.images / "bed_1.png").read_bytes() == first
    take_out(worked_on, [1], user="ann")
    put_back(worked_on, [each for each in taken_out(worked_on) if each.number == number])
    assert (worked_on.images / "bed_1.png").read_bytes() == other.read_bytes()


def test_an_image_that_took_its_caps_is_in_the_way(worked_on, tmp_path, write_photo, write_coco):
    uid = rows_of(worked_on)["annotation"][0][1]
    take_out(worked_on, [1], user="ann")
    write_photo(tmp_path / "labels" / "bed_4.png", seed=7)
    images = [{"id": 4, "file_name": "bed_4.png"}]
    import_paths(
        worked_on, [write_coco([{"image_id": 4, "uid": uid, "segmentation": [TRIANGLE]}], images=images)]
    )
    before = rows_of(worked_on)
    with pytest.raises(StoreError, match=r"bed_4\.png has caps of bed_1\.png now; take it out first"):
        put_back(worked_on, taken_out(worked_on))
    assert rows_of(worked_on) == before


def test_linked_photos_stay_where_they_are(project, tmp_path, write_photo):
    photo = write_photo(tmp_path / "in" / "bed.png")
    import_paths(project, [photo], link=True)
    take_out(project, [1], user="ann")
    let_go(project)
    assert photo.exists()


def test_let_go_it_is_gone_for_good(worked_on):
    take_out(worked_on, [1], user="ann")
    assert let_go(worked_on) == 1
    assert taken_out(worked_on) == []
    assert not (worked_on.folder / "taken_out").exists()
    assert let_go(worked_on) == 0


def test_an_unknown_image_changes_nothing(worked_on):
    before = rows_of(worked_on)
    with pytest.raises(StoreError, match="no image number 9"):
        take_out(worked_on, [1, 9], user="ann")
    assert rows_of(worked_on) == before
    assert taken_out(worked_on) == []


def test_an_edit_of_an_image_that_is_gone_is_refused(worked_on):
    take_out(worked_on, [1], user="ann")
    edit = Edit(id="late", annotation="late", image=1, base=0, cap=Cap(visible=[SQUARE]))
    from fairyring.storage.journal import Derived, commit

    (outcome,) = commit(worked_on, [Derived(edit=edit)], user="bob")
    assert type(outcome).__name__ == "Refused"
