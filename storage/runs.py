"""The runs of a project: which there are, how they are called, and what each of them saw."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from msgspec import Struct
from sqlalchemy import Connection, Row, func, select, update

from fairyring.storage.cap_validity import check_name
from fairyring.storage.db.rows import SELECT_PREDICTIONS, image_of, is_number, prediction_of, run_of
from fairyring.storage.db.schema import image, prediction, run
from fairyring.storage.errors import StoreError
from fairyring.storage.images_seen import NOTHING_ON, images_seen
from fairyring.storage.records import Image, Prediction, Run

MOST_NAMED = 5
"""How many runs a sentence names."""


class RunRow(Struct, frozen=True, kw_only=True):
    """A run in the list of all."""

    run: Run
    images: int
    """How many images it saw."""
    predictions: int
    latest_of: int
    """Of how many images it is the latest, whose predictions these show."""


def list_runs(connection: Connection) -> list[RunRow]:
    """All runs, in the order in which they were made."""
    counted = select(prediction.c.run, func.count(), func.count(prediction.c.image.distinct()))
    predictions = {row[0]: (row[1], row[2]) for row in connection.execute(counted.group_by(prediction.c.run))}
    latest = _latest_of(connection)

    def images_of(row: Row[Any]) -> int:
        with_caps, nothing_on = predictions.get(row.id, (0, 0))[1], len(row.settings.get(NOTHING_ON, ()))
        return max(with_caps + nothing_on, latest.get(row.id, 0))

    return [
        RunRow(
            run=run_of(row),
            predictions=predictions.get(row.id, (0, 0))[0],
            images=images_of(row),
            latest_of=latest.get(row.id, 0),
        )
        for row in connection.execute(select(run).order_by(run.c.id))
    ]


def all_runs(connection: Connection) -> list[Run]:
    """The same without what they hold, which takes long to count."""
    return [run_of(row) for row in connection.execute(select(run).order_by(run.c.id))]


def require_run(connection: Connection, said: str) -> Run:
    """The run of this name; else of this number, as ``list_runs`` counts.

    Raises StoreError where there is none, or several have this name.
    """
    if not said.strip():
        raise StoreError(f"A run has a name or a number, and none was given. {_those_there_are(connection)}")
    called = [run_of(row) for row in connection.execute(select(run).where(run.c.name == said))]
    if len(called) == 1:
        return called[0]
    if called:
        numbers = ", ".join(str(each.id) for each in called)
        raise StoreError(f"{len(called)} runs are called {said}; name one by its number: {numbers}.")
    number = int(said) if said.isdecimal() and is_number(int(said)) else 0
    row = connection.execute(select(run).where(run.c.id == number)).first()
    if row is None:
        raise StoreError(f"There is no run called {said}. {_those_there_are(connection)}")
    return run_of(row)


def require_two(run: Run, other: Run) -> None:
    """Raises StoreError where two runs that are to be compared are one."""
    if run.id == other.id:
        raise StoreError(f"Both are {run.name}, which is one run; choose another one to compare it with.")


def get_run(connection: Connection, number: int) -> Run:
    """The run of this number. Raises StoreError where there is none."""
    row = connection.execute(select(run).where(run.c.id == number)).first()
    if row is None:
        raise StoreError(f"The project has no run {number}.")
    return run_of(row)


def rename_run(connection: Connection, run_id: int, name: str) -> None:
    """Gives a run another name. Raises StoreError where another run has it, or it is no name."""
    check_name(name, "name of a run")
    other = connection.execute(select(run.c.id).where(run.c.name == name, run.c.id != run_id)).first()
    if other is not None:
        raise StoreError(f"Run {other.id} is called {name} already; choose another name.")
    connection.execute(update(run).where(run.c.id == run_id).values(name=name))


def images_seen_by(connection: Connection, run_id: int) -> list[Image]:
    """The images that a run saw, by name."""
    seen = image.c.id.in_(images_seen(connection, run_id))
    statement = select(image).where(seen).order_by(image.c.sort_name, image.c.id)
    return [image_of(row) for row in connection.execute(statement)]


def predictions_by(connection: Connection, run_id: int, image_id: int) -> list[Prediction]:
    """What a run said of an image, also where a later one saw it."""
    wanted = prediction.c.image == image_id, prediction.c.run == run_id
    statement = SELECT_PREDICTIONS.where(*wanted).order_by(prediction.c.id)
    return [prediction_of(row) for row in connection.execute(statement)]


def latest_runs_of(connection: Connection, image_ids: Iterable[int]) -> list[tuple[Run, int]]:
    """The runs whose predictions these images show, each with how many of them, in the order of the runs."""
    wanted = set(image_ids)
    count: dict[int, int] = {}
    for image_id, run_id in connection.execute(select(image.c.id, image.c.run)):
        if image_id in wanted and run_id is not None:
            count[run_id] = count.get(run_id, 0) + 1
    rows = connection.execute(select(run).order_by(run.c.id))
    return [(run_of(row), count[row.id]) for row in rows if row.id in count]


def _latest_of(connection: Connection) -> dict[int, int]:
    statement = select(image.c.run, func.count()).where(image.c.run.is_not(None)).group_by(image.c.run)
    return {row[0]: row[1] for row in connection.execute(statement)}


def _those_there_are(connection: Connection) -> str:
    names = list(connection.execute(select(run.c.name).order_by(run.c.id.desc()).limit(MOST_NAMED)).scalars())
    if not names:
        return "The project has none yet; fairyring predict makes one."
    return f"The latest are {', '.join(names)}; fairyring runs list shows all."
