"""The splits of the images that the list shows: counted, given to all of them, divided at random."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from sqlalchemy import Connection

from fairyring.app.jobs.splitting import divided_at_random
from fairyring.app.live.session import Session
from fairyring.app.live.tagging import put_into_splits
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.model.splits import Split
from fairyring.storage.images import ImageFilter, list_ids, splits_of

NONE = "none"
VALIDATION, TEST = 15, 15
"""Percent of the images that are kept for validation and for tests, unless somebody says otherwise."""


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the folder of the splits, folded up."""
    gui = session.client.gui
    with gui.add_folder("Splits", expand_by_default=False):
        shown = gui.add_html("")
        which = gui.add_dropdown("Put into", (*Split, NONE))
        put = gui.add_button("Put all of them there", hint="Every image that search and filters find")
        val = gui.add_number("Validation, %", VALIDATION, min=0, max=100, step=1)
        test = gui.add_number("Test, %", TEST, min=0, max=100, step=1)
        seed = gui.add_number("Seed", 0, min=0, max=10**6, step=1)
        divide = gui.add_button("Divide them at random", hint="Copies of one photo stay together")
        undo = gui.add_button("Undo splits", visible=False)
    done: list[dict[int, str | None]] = []

    async def put_all() -> None:
        ids = await workspace.read(lambda connection: list_ids(connection, session.filter))
        split = None if which.value == NONE else which.value
        await change(dict.fromkeys(ids, split))

    async def divide_all() -> None:
        shares = {Split.train: 100 - val.value - test.value, Split.val: val.value, Split.test: test.value}
        if shares[Split.train] < 0:
            session.notify("Validation and test are more than 100 % together.", "error")
            return
        divide = partial(_divided, which=session.filter, shares=shares, seed=int(seed.value))
        await change(await workspace.read(divide))

    async def change(splits: Mapping[int, str | None]) -> None:
        before = await put_into_splits(workspace, splits)
        if before:
            done.append(before)
        session.notify(f"In another split now: {len(before)} images.")

    async def take_back() -> None:
        if done:
            await put_into_splits(workspace, done.pop())

    put.on_click(person_did(session, put_all))
    divide.on_click(person_did(session, divide_all))
    undo.on_click(person_did(session, take_back))

    async def redraw() -> None:
        counts = await workspace.read(lambda connection: splits_of(connection, session.filter))
        shown.content = counted(counts).html
        put.disabled = divide.disabled = workspace.project.read_only or not counts
        undo.visible = bool(done)

    return redraw


def counted(counts: Mapping[str | None, int]) -> Markup:
    """How many of the images in the list are in which split."""
    total = sum(counts.values())
    listed = ", ".join(f"{name or NONE} {count}" for name, count in counts.items()) or "none"
    return element("div", f"{total} images found: {listed}", class_="fr-quiet")


def _divided(
    connection: Connection, *, which: ImageFilter, shares: Mapping[Split, float], seed: int
) -> dict[int, str | None]:
    return divided_at_random(connection, set(list_ids(connection, which)), shares, seed=seed)
