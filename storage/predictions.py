"""Runs of a model and their predictions, which are added and never changed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, count
from typing import Any
from uuid import uuid4

from msgspec import Struct, field, structs
from sqlalchemy import Connection, exists, func, insert, or_, select, update

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Fit
from fairyring.storage.cap_validity import are_finite, check_cap, check_name
from fairyring.storage.db.clock import now
from fairyring.storage.db.counters import recount
from fairyring.storage.db.rows import (
    ensure_category,
    latest_run_row,
    load_categories,
    require_image,
    run_of,
    values_of_fit,
)
from fairyring.storage.db.schema import image, prediction, run
from fairyring.storage.errors import StoreError
from fairyring.storage.images_seen import note_images_listed
from fairyring.storage.records import Cap, Outline, Run, RunKind


class NewPrediction(Struct, frozen=True, kw_only=True):
    """One cap as a model saw it."""

    visible: Outline
    score: float
    """Score, 0 to 1."""
    quality: float | None = None
    """Expected IoU of the outline with the visible cap, 0 to 1; None where it is not known."""
    likely_whole: LikelyEllipse | None = None
    """The whole outline that the model held to be likely; None where it did not say."""
    category: str = DEFAULT_CATEGORY
    fit: Fit = Fit()
    uid: str | None = None
    """Identifies it within its run and image: the same one again adds nothing."""
    extra: dict[str, Any] = field(default_factory=dict)


def add_run(
    connection: Connection,
    *,
    name: str,
    kind: RunKind,
    weights: str | None = None,
    settings: dict[str, Any] | None = None,
    key: str | None = None,
) -> Run:
    """Adds a run, to which predictions can then be added.

    Args:
        connection: within ``Project.write``.
        name: as people read it; where another run has it already, a number is put behind.
        kind: whence the predictions come.
        weights: SHA-256 of the weights.
        settings: whatever else decides the result.
        key: names a run that must not be made twice; an existing run of this key is returned, of this kind
            from now on.
    """
    check_name(name, "name of a run")
    if key is not None:
        known = connection.execute(select(run).where(run.c.key == key)).first()
        if known is not None:
            return _of_kind(connection, run_of(known), kind)
    values = {
        "name": _free_name(connection, name),
        "kind": kind,
        "made_at": now(),
        "weights": weights,
        "settings": settings or {},
        "key": key,
    }
    return run_of(connection.execute(insert(run).values(**values).returning(run)).one())


class RunAsked(Struct, frozen=True, kw_only=True):
    """The run that predictions of a network, or of a method without weights, are to go into."""

    name: str
    """What a new one is called, with a number behind it where another has the name."""
    weights: str | None
    """SHA-256 of the weights; None where there are none."""
    settings: dict[str, Any]
    called: str | None = None
    """What a person wants it to be called; None where nobody says."""
    redo: bool = False
    """Whether a new one is wanted in any case."""


def run_to_continue(connection: Connection, asked: RunAsked) -> Run | None:
    """The latest run, if it is of these weights and settings, and called as asked; None for a new one.

    Once another has been made since, it is a new one: an image shows what the latest run that saw it said.
    Raises StoreError where a new one cannot be called so: it is no name, or another run has it.
    """
    latest = latest_run(connection)
    same = latest is not None and latest.weights == asked.weights and latest.settings == asked.settings
    if latest is not None and same and asked.called in (None, latest.name):
        if not asked.redo:
            return latest
        if asked.called is not None:
            raise StoreError(
                f"The latest run is called {asked.called}: without --redo it goes on; or choose another name."
            )
    if asked.called is not None:
        require_free_name(connection, asked.called)
    return None


def continued_run(connection: Connection, asked: RunAsked) -> Run:
    """The run of ``run_to_continue``, or a new one. Raises StoreError as that does."""
    return run_to_continue(connection, asked) or add_run(
        connection,
        name=asked.called or asked.name,
        kind="network",
        weights=asked.weights,
        settings=asked.settings,
    )


def seen_by(connection: Connection, asked: RunAsked) -> set[int]:
    """Ids of the images that the run of ``run_to_continue`` has seen. Raises StoreError as that does."""
    run = run_to_continue(connection, asked)
    if run is None:
        return set()
    return set(connection.execute(select(image.c.id).where(image.c.run == run.id)).scalars())


def require_free_name(connection: Connection, name: str) -> None:
    """Raises StoreError where this is no name of a run, or a run has it."""
    check_name(name, "name of a run")
    other = connection.execute(select(run.c.id).where(run.c.name == name)).first()
    if other is not None:
        raise StoreError(f"Run {other.id} is called {name} already; choose another name.")


def count_unseen(connection: Connection, *, weights: str) -> int:
    """How many images the latest run has not seen, or all where it was not of these weights."""
    images = select(func.count()).select_from(image)
    latest = latest_run(connection)
    if latest is not None and latest.weights == weights:
        images = images.where(or_(image.c.run.is_(None), image.c.run != latest.id))
    return connection.execute(images).scalar_one()


def add_predictions(
    connection: Connection, *, run_id: int, image_id: int, predictions: Sequence[NewPrediction]
) -> int:
    """Stores what a run saw in an image (perhaps nothing) and returns how many were new.

    Raises:
        GeometryError: an outline cannot be used.
        StoreError: no such image, or a score or quality outside 0…1.
    """
    photo = require_image(connection, image_id)
    categories = load_categories(connection)
    known = set(
        connection.execute(
            select(prediction.c.uid).where(prediction.c.image == image_id, prediction.c.run == run_id)
        ).scalars()
    )
    rows = [
        _values(connection, new, categories, width=photo.width, height=photo.height)
        | {"run": run_id, "image": image_id}
        for new in predictions
        if new.uid not in known
    ]
    if rows:
        connection.execute(insert(prediction), rows)
    saw(connection, run_id=run_id, image_ids=[image_id])
    return len(rows)


def saw(connection: Connection, *, run_id: int, image_ids: Sequence[int]) -> None:
    """Notes that a run saw these images: it is now their latest, unless a later one saw them.

    What a second annotator labelled never is: images go on to show what the latest model said of them. Where
    nothing is labelled is kept.
    """
    later = image.c.run.is_(None) | (image.c.run < run_id)
    of_a_model = exists().where(run.c.id == run_id, run.c.kind != "second")
    for image_id in image_ids:
        connection.execute(update(image).where(image.c.id == image_id, later, of_a_model).values(run=run_id))
    recount(connection, image_ids)
    note_images_listed(connection, run_id, image_ids)


def _of_kind(connection: Connection, known: Run, kind: RunKind) -> Run:
    """The run as one of this kind. Images that it was the latest of, and is no more, show the one before."""
    if known.kind == kind:
        return known
    connection.execute(update(run).where(run.c.id == known.id).values(kind=kind))
    if kind == "second":
        before = (
            select(func.max(prediction.c.run))
            .join(run, run.c.id == prediction.c.run)
            .where(prediction.c.image == image.c.id, run.c.kind != "second")
            .scalar_subquery()
        )
        shown = list(connection.execute(select(image.c.id).where(image.c.run == known.id)).scalars())
        connection.execute(update(image).where(image.c.run == known.id).values(run=before))
        recount(connection, shown)
    return structs.replace(known, kind=kind)


def latest_run(connection: Connection) -> Run | None:
    """The run made last; what a second annotator labelled is none."""
    row = latest_run_row(connection)
    return None if row is None else run_of(row)


def _free_name(connection: Connection, name: str) -> str:
    """The name, or the first of ``name (2)``, ``name (3)`` … that no run has."""
    taken = set(
        connection.execute(select(run.c.name).where(run.c.name.startswith(name, autoescape=True))).scalars()
    )
    names = chain([name], (f"{name} ({nth})" for nth in count(2)))
    return next(each for each in names if each not in taken)


def _values(
    connection: Connection, new: NewPrediction, categories: dict[str, int], *, width: int, height: int
) -> dict[str, Any]:
    if not are_finite([new.score]) or not 0 <= new.score <= 1:
        raise StoreError(f"A score lies between 0 and 1, not at {new.score}.")
    if new.quality is not None and not 0 <= new.quality <= 1:
        raise StoreError(f"A quality lies between 0 and 1, not at {new.quality}.")
    cap = check_cap(Cap(visible=new.visible, category=new.category), width=width, height=height)
    return {
        "uid": new.uid or uuid4().hex,
        "category": ensure_category(connection, new.category, categories=categories),
        "visible": cap.visible,
        "score": float(new.score),
        "quality": new.quality,
        "likely_whole": new.likely_whole,
        "extra": new.extra,
        **values_of_fit(new.fit),
    }
