import random

import pytest
from sqlalchemy import insert, update

from fairyring.storage.comparisons import Comparison, store_comparison
from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError
from fairyring.storage.images import (
    ImageFilter,
    find_image,
    get_image,
    list_ids,
    list_images,
    position_in_list,
    sort_name,
)
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import add_run
from fairyring.storage.statuses import set_status


def names(project, which, **page):
    with project.read() as connection:
        return [row.image.file_name for row in list_images(connection, which, **page).rows]


@pytest.fixture
def many(project):
    """Forty images with every mixture of light, status, counters and review figures."""
    rng = random.Random(1)

    def fill(connection):
        run = add_run(connection, name="r", kind="simulated").id
        for number in range(40):
            name = f"{rng.choice(['Bed', 'tray', 'x%y_z'])}_{number}.jpg"
            values = {
                "file_name": name,
                "sort_name": sort_name(name),
                "path": f"images/{name}",
                "width": 10,
                "height": 10,
                "sha256": "",
                "light": rng.choice([None, "top", "side"]),
                "form": rng.choice([None, "a", "b"]),
                "status": rng.choice(["new", "annotated", "approved"]),
                "extra": {},
                "added_at": "2026-01-01T00:00:00.000Z",
                "caps": rng.randrange(4),
                "ignored": rng.randrange(2),
                "run": run,
                "predicted": rng.randrange(3),
            }
            connection.execute(insert(schema.image).values(values))
            if rng.random() < 0.6:
                figures = Comparison(
                    image=number + 1,
                    run=run,
                    version=0,
                    caps=1,
                    marked=1,
                    matched=1,
                    missed=0,
                    extra=0,
                    cdr_worst=rng.choice([0.1, 0.2, 0.5, None]),
                    worst="cap",
                )
                store_comparison(connection, figures)

    project.write(fill)
    return project


def test_names_are_sorted_as_people_count(beds):
    assert names(beds, ImageFilter()) == ["bed_1.png", "bed_2.png", "bed_10.png"]
    assert names(beds, ImageFilter(descending=True)) == ["bed_10.png", "bed_2.png", "bed_1.png"]
    assert names(beds, ImageFilter(sort="added")) == ["bed_1.png", "bed_2.png", "bed_10.png"]


def test_a_page_is_part_of_the_list_and_knows_its_length(beds):
    with beds.read() as connection:
        page = list_images(connection, ImageFilter(), offset=1, limit=1)
    assert [row.image.file_name for row in page.rows] == ["bed_2.png"]
    assert page.total == 3


@pytest.mark.parametrize(
    ("search", "found"),
    [
        ("", 3),
        ("BED", 3),
        ("_1", 2),
        ("10", 1),
        ("%", 0),
        ("_", 3),
        ("bed_1.png", 1),
        ("'; --", 0),
        ("\\", 0),
    ],
)
def test_the_search_takes_every_character_for_itself(beds, search, found):
    assert len(names(beds, ImageFilter(search=search))) == found


@pytest.mark.parametrize("search", ["GRÜN", "grün", "gru\u0308n", "STRASSE", "straße", "ΣΟΦ"])
def test_the_search_knows_upper_and_lower_case_of_all_letters(project, tmp_path, write_photo, search):
    names_on_disk = ("Grünbeet_1.png", "straße_2.png", "σοφός_3.png")
    import_paths(project, [write_photo(tmp_path / name) for name in names_on_disk])
    assert len(names(project, ImageFilter(search=search))) == 1


FILTERS = [
    ({}, lambda row: row is not None),
    ({"status": "approved"}, lambda row: row.image.status == "approved"),
    ({"light": "top", "form": "a"}, lambda row: (row.image.light, row.image.form) == ("top", "a")),
    ({"predicted": True}, lambda row: row.predicted > 0),
    ({"predicted": False}, lambda row: row.predicted == 0),
    ({"annotated": True}, lambda row: row.caps + row.ignored > 0),
    ({"annotated": False}, lambda row: row.caps + row.ignored == 0),
    ({"search": "X%Y"}, lambda row: "x%y" in row.image.file_name),
    (
        {"search": "bed", "status": "new"},
        lambda row: "Bed" in row.image.file_name and row.image.status == "new",
    ),
]


@pytest.mark.parametrize(("wanted", "fits"), FILTERS)
def test_filters_find_what_a_loop_finds(many, wanted, fits):
    with many.read() as connection:
        everything = list_images(connection, ImageFilter(), limit=100).rows
        page = list_images(connection, ImageFilter(**wanted), limit=100)
    assert page.rows == [row for row in everything if fits(row)]
    assert page.total == len(page.rows)


SORTS = {
    "caps": lambda row: row.caps,
    "added": lambda row: row.image.id,
    "name": lambda row: sort_name(row.image.file_name),
    "cdr": lambda row: row.cdr_worst,
}


@pytest.mark.parametrize("descending", [False, True])
@pytest.mark.parametrize("sort", SORTS)
def test_sorting_is_that_of_a_loop_and_images_without_a_figure_come_last(many, sort, descending):
    with many.read() as connection:
        everything = list_images(connection, ImageFilter(), limit=100).rows
        found = list_images(connection, ImageFilter(sort=sort, descending=descending), limit=100).rows
    key = SORTS[sort]
    with_figure = [row for row in everything if key(row) is not None]
    without = [row for row in everything if key(row) is None]
    assert found == sorted(with_figure, key=key, reverse=descending) + without


@pytest.mark.parametrize("which", [ImageFilter(), ImageFilter(status="new", sort="cdr", descending=True)])
def test_the_place_of_an_image_is_where_the_list_shows_it(many, which):
    with many.read() as connection:
        ids = list_ids(connection, which)
        assert ids == [row.image.id for row in list_images(connection, which, limit=100).rows]
        for position, image_id in enumerate(ids):
            place = position_in_list(connection, which, image_id)
            assert (place.position, place.count) == (position, len(ids))
            assert place.previous == (ids[position - 1] if position else None)
            assert place.next == (ids[position + 1] if position + 1 < len(ids) else None)


def test_an_image_the_filter_leaves_out_still_has_neighbours(beds):
    beds.write(lambda connection: set_status(connection, 2, "approved", user="ann"))
    with beds.read() as connection:
        place = position_in_list(connection, ImageFilter(status="new"), 2)
    assert (place.position, place.count, place.previous, place.next) == (1, 2, 1, 3)


def test_an_image_that_is_not_there_is_named(beds):
    with beds.read() as connection:
        for ask in (get_image, lambda c, number: position_in_list(c, ImageFilter(), number)):
            with pytest.raises(StoreError, match="no image number 99"):
                ask(connection, 99)
        assert find_image(connection, "bed_9.png") is None
        assert find_image(connection, "bed_10.png").id == 3


def test_a_status_is_journalled_with_who_and_when(beds):
    for status in ("annotated", "annotated", "approved"):
        assert beds.write(lambda c, status=status: set_status(c, 1, status, user="ann")).status == status
    with beds.read() as connection:
        rows = connection.execute(schema.status_change.select()).all()
    assert [(row.image, row.before, row.after, row.user) for row in rows] == [
        (1, "new", "annotated", "ann"),
        (1, "annotated", "approved", "ann"),
    ]
    assert all(row.made_at.startswith("20") for row in rows)
    with pytest.raises(StoreError, match="one of new, annotated, approved"):
        beds.write(lambda c: set_status(c, 1, "done", user="ann"))


def test_the_worst_cap_of_the_latest_comparison_is_on_its_line(many):
    with many.read() as connection:
        row = list_images(connection, ImageFilter(sort="cdr", descending=True)).rows[0]
    assert (row.cdr_worst, row.worst) == (0.5, "cap")


def test_figures_of_an_older_run_are_not_shown(many):
    later = many.write(lambda c: add_run(c, name="later", kind="network").id)
    many.write(lambda c: c.execute(update(schema.image).values(run=later)))
    with many.read() as connection:
        assert {row.cdr_worst for row in list_images(connection, ImageFilter(), limit=100).rows} == {None}


def test_where_most_is_to_gain_comes_first_every_light_and_form_in_turn_and_what_is_done_last(project):
    said = {
        "a": ("top", "new", [0.9, 0.9]),
        "b": ("top", "new", [0.3, 0.4, 0.5]),
        "c": ("side", "new", [0.8]),
        "d": ("side", "annotated", [0.3] * 9),
        "e": ("top", "new", [0.6, 0.6]),
        "f": ("side", "new", []),
    }

    numbers = {}

    def fill(connection):
        run = add_run(connection, name="r", kind="network").id
        category = connection.execute(insert(schema.category).values(name="mushroom", extra={}))
        for name, (light, status, scores) in said.items():
            values = {
                "file_name": name,
                "sort_name": name,
                "path": name,
                "width": 9,
                "height": 9,
                "sha256": "",
            }
            values |= {"light": light, "status": status, "extra": {}, "added_at": "2026", "run": run}
            [number] = connection.execute(insert(schema.image).values(values)).inserted_primary_key
            numbers[name] = number
            for k, score in enumerate(scores):
                one = {"run": run, "image": number, "uid": f"{name}{k}", "visible": [], "score": score}
                [kind] = category.inserted_primary_key
                connection.execute(insert(schema.prediction).values(one | {"category": kind, "extra": {}}))

    project.write(fill)
    order = names(project, ImageFilter(sort="gain"))
    assert order == ["b", "c", "e", "f", "a", "d"]
    assert [
        name for k in range(3) for name in names(project, ImageFilter(sort="gain"), offset=2 * k, limit=2)
    ] == order

    def around(name):
        with project.read() as connection:
            place = position_in_list(connection, ImageFilter(sort="gain"), numbers[name])
        called = {number: name for name, number in numbers.items()} | {None: None}
        return called[place.previous], place.position, called[place.next]

    assert around("c") == ("b", 1, "e")
    # Had d not been done, 9 x .7 caps would be wrong, the most of all: it leads on from where it was.
    assert around("d") == (None, 5, "b")
