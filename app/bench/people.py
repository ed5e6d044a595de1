"""How long people wait for an edit to be on disk while many others drag caps on dense beds."""

from __future__ import annotations

import asyncio
import multiprocessing
import random
import tempfile
import time
import uuid
from collections.abc import Sequence
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path

from fairyring.app.bench.crowd import add_crowds
from fairyring.app.bench.plain import synced_inserts
from fairyring.app.bench.serving import served
from fairyring.app.bench.timing import Row, p95_row, row
from fairyring.app.bench.visitor import Visitor, visitor
from fairyring.app.protocol import Edits, Fitted, Outcomes, Refit, Select, Show
from fairyring.storage.project import create_project
from fairyring.storage.records import Accepted, Cap, Edit, Prediction

PEOPLE = 20
BEDS = 5
MOVES_A_SECOND = 60
DRAG_S = (0.5, 1.5)
"""How long somebody drags one cap, from and to."""
LOOK_S = (0.3, 1.0)
"""How long somebody looks for the next cap."""


@dataclass(frozen=True)
class Waited:
    """Milliseconds that people waited for answers."""

    saved: list[float] = field(default_factory=list)
    """From the release of a cap to the acknowledgement that it is on disk."""
    fitted: list[float] = field(default_factory=list)
    """From the question for a live fit to its answer."""


def people_rows(*, quick: bool = False) -> list[Row]:
    """Measures one person alone, then many at once, each at work for half a minute."""
    people, beds, caps, seconds = (3, 1, 60, 3.0) if quick else (PEOPLE, BEDS, 449, 30.0)
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as name:
        folder = Path(name)
        with create_project(folder / "project") as project:
            add_crowds(project, folder / "beds", [f"bed_{number}.jpg" for number in range(beds)], caps=caps)
        with served(folder / "project") as server:
            alone = _at_work(server.port, people=1, beds=beds, seconds=seconds)
            together = _at_work(server.port, people=people, beds=beds, seconds=seconds)
        reference = synced_inserts(folder / "plain.db", payload="0" * 1000)
    return [
        p95_row("one person: release to saved (bare INSERT)", alone.saved, reference=reference),
        p95_row("one person: live fit", alone.fitted),
        p95_row(
            f"{people} people: release to saved (bare INSERT)",
            together.saved,
            target=150,
            reference=reference,
        ),
        p95_row(f"{people} people: live fit (one person's)", together.fitted, reference=alone.fitted),
        row(f"{people} people: edits", len(together.saved) / seconds, unit="a second"),
        row(f"{people} people: live fits", len(together.fitted) / seconds, unit="a second"),
    ]


def _at_work(port: int, *, people: int, beds: int, seconds: float) -> Waited:
    """So many people, in a process of their own."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(_work, (port, people, beds, seconds))


def _work(port: int, people: int, beds: int, seconds: float) -> Waited:
    return asyncio.run(_all_work(port, people=people, beds=beds, seconds=seconds))


async def _all_work(port: int, *, people: int, beds: int, seconds: float) -> Waited:
    async with AsyncExitStack() as tabs:
        opened: list[tuple[Visitor, Show]] = []
        for number in range(people):
            tab = await tabs.enter_async_context(visitor(port, name=f"Ann {number}", image=1 + number % beds))
            opened.append((tab, await tab.expect(Show)))
        ends, waited = time.perf_counter() + seconds, Waited()
        # Those who share a bed have caps of their own.
        shares = [
            _open_ones(shown)[number // beds :: -(-people // beds)]
            for number, (_, shown) in enumerate(opened)
        ]
        everybody = (
            _correct(tab, share, waited, chance=random.Random(number), ends=ends)
            for number, ((tab, _), share) in enumerate(zip(opened, shares, strict=True))
        )
        await asyncio.gather(*everybody)
        return waited


def _open_ones(shown: Show) -> list[Prediction]:
    """The predictions that nobody has accepted yet."""
    taken = {annotation.cap.prediction for annotation in shown.contents.annotations}
    return [each for each in shown.contents.predictions if each.id not in taken]


async def _correct(
    tab: Visitor, share: Sequence[Prediction], waited: Waited, *, chance: random.Random, ends: float
) -> None:
    """One person drags a vertex of one cap after another, until time is up."""
    for prediction in chance.sample(share, len(share)):
        if time.perf_counter() > ends:
            return
        await tab.send(Select(predictions=[prediction.id]))
        await asyncio.sleep(chance.uniform(*LOOK_S))
        await _drag(tab, prediction, waited, seconds=chance.uniform(*DRAG_S))


async def _drag(tab: Visitor, prediction: Prediction, waited: Waited, *, seconds: float) -> None:
    """Asks for a live fit with every move, one at a time, as the editor does; then lets go."""
    uid, began, moves = uuid.uuid4().hex, time.perf_counter(), 0
    cap = Cap(visible=prediction.visible, prediction=prediction.id)
    while time.perf_counter() < began + seconds:
        moves += 1
        first, *others = prediction.visible
        cap = Cap(visible=[[first[0] + moves / 20, *first[1:]], *others], prediction=prediction.id)
        asked = time.perf_counter()
        await tab.send(Refit(seq=moves, image=prediction.image, annotation=uid, cap=cap))
        await tab.expect(Fitted)
        answered = time.perf_counter()
        waited.fitted.append(1e3 * (answered - asked))
        await asyncio.sleep(max(0, asked + 1 / MOVES_A_SECOND - answered))
    released = time.perf_counter()
    edit = Edit(id=uuid.uuid4().hex, annotation=uid, image=prediction.image, base=0, cap=cap)
    await tab.send(Edits(edits=[edit]))
    (outcome,) = (await tab.expect(Outcomes)).outcomes
    assert isinstance(outcome, Accepted), outcome
    waited.saved.append(1e3 * (time.perf_counter() - released))
