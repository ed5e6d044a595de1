"""What the store holds, read past its own doors: deleted annotations, every run, stale comparisons."""

from __future__ import annotations

from sqlalchemy import Connection, select

from fairyring.storage.comparisons import Comparison, list_comparisons
from fairyring.storage.db.rows import SELECT_ANNOTATIONS, annotation_of, run_of
from fairyring.storage.db.schema import annotation, run
from fairyring.storage.records import Annotation, Run


def stored_annotation(connection: Connection, uid: str) -> Annotation | None:
    """One annotation, deleted or not."""
    row = connection.execute(SELECT_ANNOTATIONS.where(annotation.c.uid == uid)).first()
    return None if row is None else annotation_of(row)


def stored_runs(connection: Connection) -> list[Run]:
    """All runs, the latest first."""
    return [run_of(row) for row in connection.execute(select(run).order_by(run.c.id.desc()))]


def stored_comparison(connection: Connection, image_id: int, run_id: int) -> Comparison | None:
    """The figures of one image and run, stale or not; None where there are none."""
    rows = list_comparisons(connection, run_id).rows
    return next((row.comparison for row in rows if row.comparison.image == image_id), None)
