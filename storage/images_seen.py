"""Which images a run saw: those of its predictions, those it is the latest of, and those it found nothing on.

That a second annotator labelled nothing on an image is in no other table, as their run is never an image's
latest; the numbers of these images stand in its settings.
"""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection, Select, bindparam, select, union, update

from fairyring.storage.db.schema import image, prediction, run

NOTHING_ON = "labelled_nothing_on"


def images_seen(connection: Connection, run_id: int) -> Select[tuple[int]]:
    """A query for the numbers of the images that a run saw."""
    # Written into the statement: a file may list more images than a database takes parameters.
    nothing_on = bindparam("nothing_on", labelled_nothing_on(connection, run_id), expanding=True)
    nothing_on.literal_execute = True
    seen = union(
        select(prediction.c.image).where(prediction.c.run == run_id),
        select(image.c.id).where(image.c.run == run_id),
        select(image.c.id).where(image.c.id.in_(nothing_on)),
    ).subquery()
    return select(seen.c.image)


def labelled_nothing_on(connection: Connection, run_id: int) -> list[int]:
    """The images that a second annotator looked at, as their files list them, and labelled nothing on."""
    settings = connection.execute(select(run.c.settings).where(run.c.id == run_id)).scalar_one_or_none()
    return list((settings or {}).get(NOTHING_ON, ()))


def note_images_listed(connection: Connection, run_id: int, image_ids: Iterable[int]) -> None:
    """Keeps which of the images that its files list a second annotator labelled nothing on."""
    row = connection.execute(select(run.c.kind, run.c.settings).where(run.c.id == run_id)).one()
    if row.kind != "second":
        return
    labelled = connection.execute(select(prediction.c.image).where(prediction.c.run == run_id)).scalars()
    known = row.settings.get(NOTHING_ON, [])
    nothing_on = sorted({*known, *image_ids} - {*labelled})
    if nothing_on != known:
        settings = row.settings | {NOTHING_ON: nothing_on}
        connection.execute(update(run).where(run.c.id == run_id).values(settings=settings))
