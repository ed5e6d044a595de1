"""Whatever people, the line and the server do, a tab and the journal end up the same."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager

from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.storage.journal import history
from fairyring.storage.records import STATUSES
from tests.support.kept import all_caps
from tests.support.two_sides import TwoSides, triangle

Begin = Callable[[], AbstractContextManager[TwoSides]]
Step = tuple[str, int]
"""What happens, and a number that says to which cap, or where."""

BOW_TIE = [[0.0, 0.0, 40.0, 40.0, 40.0, 0.0, 0.0, 40.0]]
BY_HAND = ("create", "move", "move two", "cross", "remove", "hold", "release", "say", "undo", "redo")
ALONE = (*BY_HAND, "serve", "lose", "break", "reload")
TOGETHER = (*ALONE, "spoil", "bob changes", "bob deletes", "bob says", "settle")

traced = settings(derandomize=True, database=None, max_examples=40)


def traces(steps: Iterable[str], *, longest: int) -> st.SearchStrategy[list[Step]]:
    """Random lists of steps, of which some make enough caps for the others to have something to do with."""
    step = st.tuples(st.sampled_from(["create", "move", *steps]), st.integers(0, 80))
    return st.lists(step, min_size=5, max_size=longest)


def happen(sides: TwoSides, step: Step) -> None:
    """One step; on an image without caps a cap is made instead."""
    what, number = step
    live = list(sides.look.live)
    if what in ("undo", "redo"):
        sides.do(what)
    elif what == "serve":
        sides.serve()
    elif what == "lose":
        sides.serve(answer=False)
        sides.cut()
    elif what == "break":
        sides.cut() if sides.up else sides.reconnect()
    elif what == "reload":
        sides.reload()
    elif what == "say":
        sides.say(STATUSES[number % 3])
    elif what == "bob says":
        sides.bob_says(STATUSES[number % 3])
    elif what == "release":
        sides.release(number)
    elif what == "create" or not live:
        sides.draw(number)
    else:
        change(sides, what, live[number % len(live)], number)


def change(sides: TwoSides, what: str, uid: str, number: int) -> None:
    """A step that is about a cap."""
    if what == "move":
        sides.move(uid, number)
    elif what == "hold":
        sides.do("hold", uid)
    elif what == "move two":
        others = {uid, next(iter(sides.look.live))}
        sides.become(**{other: sides.replaced(other, visible=triangle(number)) for other in others})
    elif what == "cross":
        sides.become(**{uid: sides.replaced(uid, visible=BOW_TIE)})
    elif what == "remove":
        sides.become(**{uid: None})
    elif what == "spoil":
        sides.become(**{uid: sides.replaced(uid, category="toadstool")})
    elif what == "settle":
        settle(sides, number)
    elif uid in sides.there:
        sides.bob(uid, **({"cap": None} if what == "bob deletes" else {"order": number}))
        sides.tell_of(uid)


def settle(sides: TwoSides, number: int) -> None:
    """Ada decides about the oldest conflict, if there is one."""
    for conflict in sides.look.conflicts[:1]:
        sides.do("resolve", conflict.uid, ("mine", "theirs")[number % 2])


def come_to_rest(sides: TwoSides) -> None:
    """The line stays up, everything is sent, and every conflict is decided."""
    if not sides.up:
        sides.reconnect()
    sides.drain()
    for number in range(200):
        if not sides.look.conflicts:
            break
        settle(sides, number)
        sides.drain()


@traced
@given(trace=traces(ALONE, longest=60))
def test_alone_with_a_line_that_breaks_nothing_is_lost_refused_or_in_conflict(
    begin: Begin, trace: list[Step]
) -> None:
    with begin() as sides:
        for step in trace:
            happen(sides, step)
        shown = sides.look.live
        come_to_rest(sides)
        assert sides.agree
        assert sides.look.waiting == 0
        assert sides.look.conflicts == sides.refused == []
        untouched = {uid for uid, cap in shown.items() if cap.visible != BOW_TIE}
        assert {uid: sides.there[uid] for uid in untouched} == {uid: shown[uid] for uid in untouched}
        with sides.project.read() as connection:
            for uid in all_caps(sides.project.folder):
                revisions = [entry.revision for entry in history(connection, uid)]
                assert revisions == list(range(1, len(revisions) + 1))


@traced
@given(trace=traces(TOGETHER, longest=60))
def test_with_others_at_work_both_sides_end_up_the_same_once_every_conflict_is_decided(
    begin: Begin, trace: list[Step]
) -> None:
    with begin() as sides:
        for step in trace:
            happen(sides, step)
        come_to_rest(sides)
        assert sides.look.conflicts == []
        assert sides.look.waiting == 0
        assert sides.agree


@traced
@given(trace=traces(("create", "move", "move two", "remove"), longest=25), served=st.lists(st.booleans()))
def test_undoing_everything_leads_back_and_redoing_everything_forth(
    begin: Begin, trace: list[Step], served: list[bool]
) -> None:
    with begin() as sides:
        past = [sides.look.live]
        for step in trace:
            happen(sides, step)
            past.append(sides.look.live)
        ways = [("undo", caps) for caps in past[-2::-1]] + [("redo", caps) for caps in past[1:]]
        for number, (way, expected) in enumerate(ways):
            if number < len(served) and served[number]:
                sides.drain()
            sides.do(way)
            assert sides.look.live == expected
        come_to_rest(sides)
        assert sides.there == past[-1]
