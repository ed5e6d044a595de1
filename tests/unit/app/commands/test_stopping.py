"""How a command hears that it is to stop."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator

import pytest

from fairyring.app.commands.stopping import swallowed_interrupts_again


@pytest.fixture
def _interrupted_by_both() -> Iterator[None]:
    before = {
        number: signal.signal(number, signal.default_int_handler)
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


class Finalized:
    """Of what its finalizer raises, Python says that it was ignored."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("_interrupted_by_both")
def test_ctrl_c_in_a_finalizer_stops_what_follows() -> None:
    went_on = []

    def interrupted_in_a_finalizer() -> None:
        Finalized()
        went_on.append("from the finalizer")
        time.sleep(20)

    with pytest.raises(KeyboardInterrupt), swallowed_interrupts_again():
        interrupted_in_a_finalizer()
    assert went_on


def test_other_errors_in_finalizers_are_told_as_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    class Broken:
        def __del__(self) -> None:
            raise ValueError("of a finalizer")

    told: list[BaseException | None] = []
    monkeypatch.setattr("sys.unraisablehook", lambda unraisable: told.append(unraisable.exc_value))
    with swallowed_interrupts_again():
        Broken()
    assert [str(error) for error in told] == ["of a finalizer"]
