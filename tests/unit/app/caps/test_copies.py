"""Copies of an image's caps in another process answer as the caps themselves would."""

from __future__ import annotations

import asyncio
import pickle
from collections.abc import Iterator

import pytest
from msgspec.structs import replace

from fairyring.app.caps import copies
from fairyring.app.caps.copies import Copy
from fairyring.app.caps.fitting import Fitting, known_statistics
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.whole_outlines import refit
from fairyring.app.protocol import Refit
from fairyring.app.workers.worker import Worker, WorkerError
from fairyring.storage.records import Annotation, Cap, Image
from tests.support.errands import die
from tests.unit.app.conftest import circle

IMAGE = Image(id=1, file_name="a.jpg", path="a.jpg", width=400, height=300, sha256="0" * 64)
DRAGGED = Refit(seq=1, image=1, annotation="cap 3", cap=Cap(visible=circle(153, 100, 26)))


def cap_at(number: int, x: float, *, revision: int = 1) -> Annotation:
    cap = Cap(visible=circle(x, 100, 26))
    return Annotation(uid=f"cap {number}", image=1, revision=revision, cap=cap)


def caps(*, count: int = 7) -> ImageCaps:
    """A row of caps that overlap."""
    annotations = [cap_at(number, 30 + 40 * number) for number in range(count)]
    by_uid = {annotation.uid: annotation for annotation in annotations}
    return ImageCaps(IMAGE, by_uid, [], Fitting(IMAGE, known_statistics(IMAGE)))


@pytest.fixture(params=[True, False], ids=["process", "thread"])
def worker(request: pytest.FixtureRequest) -> Iterator[Worker]:
    made = Worker("fits", apart=request.param)
    yield made
    made.close()


def uids(asked: ImageCaps) -> list[str]:
    return sorted(asked.annotations)


def revision_of_first(asked: ImageCaps) -> int:
    return asked.annotations["cap 0"].revision


def kill(_: ImageCaps) -> None:
    die()


def test_a_copy_answers_to_the_last_digit_as_the_caps_do(worker: Worker) -> None:
    shown = caps()
    here = refit(shown, DRAGGED)
    there = asyncio.run(Copy().ask(worker, shown, refit, DRAGGED))
    assert there == here
    assert there.fit.centre is not None


def test_a_copy_follows_every_change(worker: Worker) -> None:
    async def ask() -> None:
        copy, shown = Copy(), caps()
        assert await copy.ask(worker, shown, revision_of_first) == 1
        changed = shown.with_annotations({**shown.annotations, "cap 0": cap_at(0, 31, revision=2)})
        assert await copy.ask(worker, changed, revision_of_first) == 2
        assert await copy.ask(worker, shown, revision_of_first) == 1
        fewer = shown.with_annotations({"cap 0": shown.annotations["cap 0"]})
        assert await copy.ask(worker, fewer, uids) == ["cap 0"]
        reopened = caps(count=2)
        assert await copy.ask(worker, reopened, uids) == ["cap 0", "cap 1"]

    asyncio.run(ask())


def test_what_has_not_changed_does_not_travel_again() -> None:
    copy, shown = Copy(), caps(count=100)
    sizes = [len(pickle.dumps(copy._update(sent, shown))) for sent in (None, shown)]
    assert sizes[1] < sizes[0] / 20


def test_a_lost_copy_is_sent_anew(worker: Worker, monkeypatch: pytest.MonkeyPatch) -> None:
    """A thread keeps few copies; a process dies."""
    monkeypatch.setattr(copies, "MOST_KEPT", 1)

    async def ask() -> None:
        copy, other, shown = Copy(), Copy(), caps()
        assert len(await copy.ask(worker, shown, uids)) == 7
        if worker._apart:
            with pytest.raises(WorkerError):
                await other.ask(worker, caps(), kill)
        else:
            await other.ask(worker, caps(), uids)
        assert len(await copy.ask(worker, shown, uids)) == 7

    asyncio.run(ask())


def test_two_workers_may_keep_a_copy_of_one_tab_s_caps() -> None:
    async def ask() -> None:
        workers = [Worker(name, apart=False) for name in ("fits", "patient")]
        copy, shown = Copy(), caps()
        for revision in range(2, 6):
            first = replace(shown.annotations["cap 0"], revision=revision)
            shown = shown.with_annotations({**shown.annotations, "cap 0": first})
            assert await copy.ask(workers[revision % 2], shown, revision_of_first) == revision
        for worker in workers:
            worker.close()

    asyncio.run(ask())
