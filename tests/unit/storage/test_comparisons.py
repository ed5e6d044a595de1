import pytest
from msgspec import structs

from fairyring.storage.comparisons import (
    Comparison,
    list_comparisons,
    stale_images,
    store_comparison,
)
from fairyring.storage.contents import load_version
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import add_predictions, add_run
from fairyring.storage.records import Cap, Edit
from tests.support.stored import stored_comparison


def figures(image, **values):
    plain = {
        "image": image,
        "run": 1,
        "version": 0,
        "caps": 2,
        "marked": 2,
        "matched": 1,
        "missed": 1,
        "extra": 3,
    }
    return Comparison(**(plain | values))


@pytest.fixture
def reviewed(beds, square):
    """Run 1 saw all three images; images 1 and 2 have a cap."""

    def predict(connection):
        run = add_run(connection, name="r", kind="simulated")
        for image in (1, 2, 3):
            add_predictions(connection, run_id=run.id, image_id=image, predictions=[])

    beds.write(predict)
    for image in (1, 2):
        edit = Edit(id=f"e{image}", annotation=f"cap{image}", image=image, base=0, cap=Cap(visible=square))
        commit(beds, [Derived(edit=edit)], user="ann")
    return beds


def version(project, image):
    with project.read() as connection:
        return load_version(connection, image)


def test_figures_come_back_as_they_were_stored_and_replace_older_ones(reviewed):
    whole = figures(
        1, cdr_mean=0.25, cdr_worst=0.5, worst="cap1", px_mean=1.5, relative_mean=0.02, dx=-0.5, dy=0.125
    )
    for stored in (figures(1), whole):
        reviewed.write(lambda c, stored=stored: store_comparison(c, stored))
        with reviewed.read() as connection:
            assert stored_comparison(connection, 1, 1) == stored
    with reviewed.read() as connection:
        assert list_comparisons(connection, 1).total == 1
        assert stored_comparison(connection, 2, 1) is None


def test_an_edit_makes_the_figures_stale(reviewed, square):
    with reviewed.read() as connection:
        assert stale_images(connection, 1) == [1, 2]
    for image in (1, 2):
        now = figures(image, version=version(reviewed, image))
        reviewed.write(lambda c, now=now: store_comparison(c, now))
    with reviewed.read() as connection:
        assert stale_images(connection, 1) == []
        assert not any(row.stale for row in list_comparisons(connection, 1).rows)
    edit = Edit(id="later", annotation="cap1", image=1, base=1, cap=Cap(visible=square, doubtful=True))
    commit(reviewed, [Derived(edit=edit)], user="ann")
    with reviewed.read() as connection:
        assert stale_images(connection, 1) == [1]
        assert {row.file_name: row.stale for row in list_comparisons(connection, 1).rows} == {
            "bed_1.png": True,
            "bed_2.png": False,
        }


def test_figures_computed_before_an_edit_are_stale_when_they_arrive_after_it(reviewed, square):
    early = version(reviewed, 1)
    edit = Edit(id="meanwhile", annotation="cap1", image=1, base=1, cap=None)
    other = Edit(id="other", annotation="cap9", image=1, base=0, cap=Cap(visible=square))
    commit(reviewed, [Derived(edit=edit), Derived(edit=other)], user="ann")
    reviewed.write(lambda c: store_comparison(c, figures(1, version=early)))
    with reviewed.read() as connection:
        assert 1 in stale_images(connection, 1)


@pytest.mark.parametrize("sort", ["name", "caps", "marked", "missed", "extra", "cdr_mean", "cdr_worst"])
@pytest.mark.parametrize("descending", [False, True])
def test_the_review_is_sorted_and_what_has_no_figure_comes_last(reviewed, sort, descending):
    low = figures(1, cdr_mean=0.1, cdr_worst=0.2, caps=1, marked=1, missed=1, extra=1)
    high = figures(2, cdr_mean=0.3, cdr_worst=0.4, caps=5, marked=5, missed=5, extra=5)
    none = figures(3, cdr_mean=None, caps=3, marked=3, missed=3, extra=3)
    for stored in (high, none, low):
        reviewed.write(lambda c, stored=stored: store_comparison(c, stored))
    with reviewed.read() as connection:
        rows = list_comparisons(connection, 1, sort=sort, descending=descending).rows
        first = list_comparisons(connection, 1, sort=sort, descending=descending, offset=1, limit=1)
    order = [row.comparison.image for row in rows]
    if sort.startswith("cdr"):
        assert order == ([2, 1, 3] if descending else [1, 2, 3])
    elif sort == "name":
        assert order == ([3, 2, 1] if descending else [1, 2, 3])
    else:
        assert order == ([2, 3, 1] if descending else [1, 3, 2])
    assert (first.rows, first.total) == ([rows[1]], 3)


def test_figures_belong_to_one_run(reviewed):
    second = reviewed.write(lambda c: add_run(c, name="second", kind="network").id)
    reviewed.write(lambda c: store_comparison(c, figures(1)))
    reviewed.write(lambda c: store_comparison(c, structs.replace(figures(1), run=second, caps=7)))
    with reviewed.read() as connection:
        assert stored_comparison(connection, 1, 1).caps == 2
        assert stored_comparison(connection, 1, second).caps == 7
