"""A process that computes for the server: whatever happens to it, every request is answered."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from fairyring.app.workers import worker as workers
from fairyring.app.workers.worker import LAST, URGENT, Worker, WorkerError
from fairyring.model.errors import FairyringError
from tests.support.descendants import is_running
from tests.support.errands import die, die_the_first_time, note, refuse, wait_for
from tests.support.tab import until


@pytest.fixture
def worker() -> Iterator[Worker]:
    made = Worker("one", patience_s=30)
    yield made
    made.close()


def test_it_works_in_a_process_of_its_own_which_stays(worker: Worker) -> None:
    first, second = worker.run(os.getpid), worker.run(os.getpid)
    assert first == second != os.getpid()


def test_ctrl_c_which_reaches_all_processes_of_a_terminal_is_not_for_it(worker: Worker) -> None:
    pid = worker.run(os.getpid)
    os.kill(pid, signal.SIGINT)
    assert worker.run(os.getpid) == pid
    assert worker.started == 1


def test_what_is_raised_there_is_raised_here(worker: Worker) -> None:
    with pytest.raises(FairyringError, match="too many points") as raised:
        worker.run(refuse, "too many points")
    assert str(raised.value) == "too many points"
    assert "in refuse" in raised.value.__notes__[0]


def test_what_is_urgent_comes_first_and_what_nobody_waits_for_not_at_all(
    worker: Worker, tmp_path: Path
) -> None:
    busy = worker.ask(lambda: (wait_for, (tmp_path / "go",)))
    until(busy.running, "it to begin")
    waiting = [
        worker.ask(lambda name=name: (note, (name, tmp_path / "notes")), urgency=urgency)
        for name, urgency in (("image", LAST), ("cap", 1), ("edit", URGENT), ("left", URGENT), ("next", 1))
    ]
    waiting[3].cancel()
    (tmp_path / "go").touch()
    for answer in (waiting[0], waiting[4]):
        answer.result(timeout=10)
    assert (tmp_path / "notes").read_text().split() == ["edit", "cap", "next", "image"]


def test_a_process_that_dies_is_replaced_and_asked_again(worker: Worker, tmp_path: Path) -> None:
    before = worker.run(os.getpid)
    assert worker.run(die_the_first_time, tmp_path / "seen") == "done"
    assert worker.run(os.getpid) != before


def test_what_kills_every_process_is_given_up_and_the_next_request_answered(worker: Worker) -> None:
    with pytest.raises(WorkerError, match="died"):
        worker.run(die)
    assert worker.run(os.getpid) != os.getpid()


def test_what_never_ends_is_ended() -> None:
    worker = Worker("one", patience_s=0.3)
    try:
        with pytest.raises(WorkerError):
            worker.run(time.sleep, 60)
        assert worker.run(abs, -3) == 3
    finally:
        worker.close()


def test_closing_ends_the_process_in_the_middle_and_answers_those_who_wait(tmp_path: Path) -> None:
    worker = Worker("one")
    pid = worker.run(os.getpid)
    busy = worker.ask(lambda: (wait_for, (tmp_path / "never",)))
    until(busy.running, "it to begin")
    waiting = worker.ask(lambda: (abs, (-1,)))
    worker.close()
    assert isinstance(busy.exception(timeout=5), WorkerError)
    assert waiting.cancelled()
    assert worker.ask(lambda: (abs, (-1,))).cancelled()
    assert not is_running(pid)


def test_where_no_process_can_be_started_a_thread_does_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(_self: object, **_: object) -> None:
        raise workers._DiedError("no memory", had_begun=False)

    monkeypatch.setattr(workers._Process, "__init__", fails)
    worker = Worker("one")
    assert worker.run(os.getpid) == os.getpid()
    worker.close()


def test_the_process_ends_with_a_server_that_is_killed() -> None:
    script = (
        "import os, time\n"
        "from fairyring.app.workers.worker import Worker\n"
        "if __name__ == '__main__':\n"
        "    print(Worker('one').run(os.getpid), flush=True)\n"
        "    time.sleep(60)\n"
    )
    server = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    pid = int(server.stdout.readline())
    assert is_running(pid)
    os.kill(server.pid, signal.SIGKILL)
    server.wait()
    until(lambda: not is_running(pid), "the worker to end")
