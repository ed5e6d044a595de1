"""Asks people to mark caps again, on a piece of the photo without their marks, and keeps the answers."""

from __future__ import annotations

import random
from functools import partial

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.addresses import photo_address
from fairyring.app.caps.records import class_of_mark, truth_record
from fairyring.app.caps.repeated import use_repeats
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import KeptAgain, MarkAgain, MarkedAgain
from fairyring.model.geometry.outline_checks import check_mark
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Circle, bounds_of_outline, polygon_of_shape
from fairyring.storage.contents import load_annotation
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.records import Annotation, Image, Repeat
from fairyring.storage.repeats import DueRepeat, due_repeat, store_repeat

AROUND = 2.2
"""Side of the piece that is shown, in sides of the cap's box."""
OFF_CENTRE = 0.25
"""The cap lies up to so many sides of its box from the middle, which would give its centre away."""


async def ask_again(workspace: Workspace, session: Session, *, quiet: bool) -> None:
    """Sends a tab the next cap that its person is to mark again."""
    besides = session.image.id if session.image else None
    due = await workspace.read(partial(due_repeat, user=session.user, besides=besides))
    if due is not None:
        image, cap = await workspace.read(partial(_load, due=due))
        session.send(await anyio.to_thread.run_sync(question_about, due, image, cap))
    elif not quiet:
        session.notify("Nothing is to be marked again now.")


async def keep_again(workspace: Workspace, session: Session, made: MarkedAgain) -> None:
    """Keeps a second mark, and tells the tab once it is on disk. Raises FairyringError where it is none."""
    kept = await anyio.to_thread.run_sync(partial(_keep, workspace, made, user=session.user))
    session.send(KeptAgain(id=kept.id))
    workspace.follow("desk", "review", "gallery", "plots", "cap_plot")


def question_about(due: DueRepeat, image: Image, cap: Annotation) -> MarkAgain:
    """What to show of a photo so that a cap can be marked again; the same for the same cap every time."""
    chance = random.Random(due.annotation)
    left, top, width, height = _bounds(cap)
    side = max(width, height)
    x = left + width / 2 + chance.uniform(-OFF_CENTRE, OFF_CENTRE) * side
    y = top + height / 2 + chance.uniform(-OFF_CENTRE, OFF_CENTRE) * side
    reach = AROUND * side / 2
    return MarkAgain(
        annotation=cap.uid,
        photo=photo_address(image),
        width=image.width,
        box=(x - reach, y - reach, x + reach, y + reach),
        at=_point_in(cap, image, chance),
        mirrored=due.mirrored,
        mark="circle" if isinstance(cap.cap.mark, Circle) else "polygon",
        left=due.left,
    )


def _load(connection: Connection, *, due: DueRepeat) -> tuple[Image, Annotation]:
    cap = load_annotation(connection, due.annotation)
    assert cap is not None, "caps are never removed from under a transaction that has just read them"
    return get_image(connection, due.image), cap


def _bounds(cap: Annotation) -> tuple[float, float, float, float]:
    """Left, top, width and height of a cap, hidden parts and all."""
    whole = [polygon_of_shape(cap.whole)] if cap.whole is not None else []
    return bounds_of_outline([*cap.cap.visible, *whole])


def _point_in(cap: Annotation, image: Image, chance: random.Random) -> tuple[float, float]:
    """The centre of a pixel of the cap that is in sight, drawn by chance."""
    outline = cap.cap.visible or ([polygon_of_shape(cap.whole)] if cap.whole is not None else [])
    ys, xs = mask_of_outline(outline, height=image.height, width=image.width).nonzero()
    if not len(xs):
        left, top, width, height = _bounds(cap)
        return left + width / 2, top + height / 2
    nth = chance.randrange(len(xs))
    return float(xs[nth]) + 0.5, float(ys[nth]) + 0.5


def _keep(workspace: Workspace, made: MarkedAgain, *, user: str) -> Repeat:
    with workspace.project.read() as connection:
        cap = load_annotation(connection, made.annotation)
        if cap is None or cap.cap.mark is None:
            raise StoreError("This cap has no mark any more, so a second one says nothing of it.")
        image = get_image(connection, cap.image)
    of = class_of_mark(truth_record(cap, image), cap.cap.mark, annotator=user)
    repeat = Repeat(
        id=made.id,
        annotation=made.annotation,
        image=image.id,
        user=user,
        mirrored=made.mirrored,
        first=cap.cap.mark,
        second=check_mark(made.mark, width=image.width, height=image.height),
        size=of.size,
        visibility=of.visibility,
    )

    def store(connection: Connection) -> None:
        store_repeat(connection, repeat)
        use_repeats(connection, user)

    workspace.project.write(store)
    return repeat
