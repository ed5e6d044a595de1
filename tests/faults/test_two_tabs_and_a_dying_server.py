"""Two tabs, a server that dies and the journal, against a plain model of what each edit does."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fairyring.storage.journal import history
from fairyring.storage.project import open_project
from fairyring.storage.records import STATUSES, Cap, Edit
from tests.support.browser_side import BrowserSide
from tests.support.dying_store import DyingStore
from tests.support.how_much import by_form
from tests.support.kept import all_caps, number_of_edits
from tests.support.plain_bed import make_empty_bed
from tests.support.two_sides import TwoSides, triangle

EXAMPLES = by_form(short=15, usual=150, long=3000)
BY_HAND = ("draw", "move", "flag", "remove", "hold", "release", "say", "undo", "redo", "spoil")
BY_CHANCE = ("serve", "serve", "serve", "lose", "break", "reload", "die")
Step = tuple[str, int, int]
"""What happens, in which tab, and a number that says to which cap, or where."""


@dataclass
class World:
    """Both tabs, and what a plain model says that the store holds."""

    tabs: list[TwoSides]
    store: DyingStore
    model: dict[str, list[Cap | None]] = field(default_factory=dict)
    """Every state of each cap, the first one first; a state is there once, when its edit is acknowledged."""
    seen: set[str] = field(default_factory=set)
    """Ids of the edits that are in the model."""

    def serve(self, nth: int, *, answer: bool = True) -> bool:
        """The server answers one message of a tab, and tells the other one what has changed."""
        tab, other = self.tabs[nth], self.tabs[1 - nth]
        edits, before = tab.next_edits(), tab.image.status
        if not tab.serve(answer=answer):
            return False
        self.enter(edits)
        for uid in {edit.annotation for edit in edits} & set(self.model):
            other.tell_of(uid)
        if tab.image.status != before:
            other.hear_status()
        return True

    def enter(self, edits: Sequence[Edit]) -> None:
        """Notes in the model what becomes of these edits."""
        for edit in edits:
            states = self.model.get(edit.annotation, [])
            spoilt = edit.cap is not None and edit.cap.category == "toadstool"
            twice_gone = edit.cap is None and (not states or states[-1] is None)
            if edit.id not in self.seen and edit.base == len(states) and not spoilt and not twice_gone:
                self.model[edit.annotation] = [*states, edit.cap]
                self.seen.add(edit.id)

    def die(self, nth: int, *, after_s: float) -> None:
        """The server is killed at work on a message of a tab: all of it is stored, or nothing of it.

        Whatever else is on its way is lost, and both tabs lose their line.
        """
        tab = self.tabs[nth]
        edits, before = tab.next_edits(), number_of_edits(tab.project.folder)
        tab.have_die(self.store, after_s=after_s)
        if number_of_edits(tab.project.folder) > before:
            self.enter(edits)
        for tab in self.tabs:
            tab.cut()

    def check_conflicts(self) -> None:
        """Nobody is asked about what they did themselves."""
        for tab in self.tabs:
            assert all(conflict.user != tab.user for conflict in tab.look.conflicts)

    def rest(self) -> None:
        """The lines stay up, everything is sent, and every conflict is decided for the one who is asked."""
        for _ in range(100):
            for tab in self.tabs:
                if not tab.up:
                    tab.reconnect()
            while self.serve(0) or self.serve(1):
                pass
            self.check_conflicts()
            asked = [tab for tab in self.tabs if tab.look.conflicts]
            if not asked:
                return
            asked[0].do("resolve", asked[0].look.conflicts[0].uid, "mine")
        raise AssertionError("conflicts without end")


def happen(world: World, step: Step) -> None:
    what, nth, number = step
    tab = world.tabs[nth]
    live = list(tab.look.live)
    if what == "serve":
        world.serve(nth)
    elif what == "lose":
        world.serve(nth, answer=False)
        tab.cut()
    elif what == "break":
        tab.cut() if tab.up else tab.reconnect()
    elif what == "reload":
        tab.reload()
    elif what == "die":
        world.die(nth, after_s=number / 4000)
    elif what in ("undo", "redo"):
        tab.do(what)
    elif what == "say":
        tab.say(STATUSES[number % 3])
    elif what == "release":
        tab.release(number)
    elif what == "draw" or not live:
        tab.draw(number)
    else:
        change(tab, what, live[number % len(live)], number)


def change(tab: TwoSides, what: str, uid: str, number: int) -> None:
    """Something that is done to a cap."""
    if what == "move":
        tab.move(uid, number)
    elif what == "flag":
        tab.become(**{uid: tab.replaced(uid, doubtful=not tab.look.live[uid].doubtful)})
    elif what == "remove":
        tab.become(**{uid: None})
    elif what == "spoil":
        tab.become(**{uid: tab.replaced(uid, category="toadstool", visible=triangle(number))})
    elif what == "hold":
        tab.do("hold", uid)


@pytest.fixture(scope="module")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_empty_bed(tmp_path_factory.mktemp("two tabs"))


@pytest.fixture(scope="module")
def browsers() -> Iterator[list[BrowserSide]]:
    with BrowserSide() as first, BrowserSide() as second:
        yield [first, second]


@contextmanager
def begun(made_once: Path, browsers: list[BrowserSide], folder: Path) -> Iterator[World]:
    beds = shutil.copytree(made_once, folder / "beds")
    with open_project(beds) as project, DyingStore(beds) as store:
        sides = zip(browsers, ("Ada", "Ben"), strict=True)
        yield World([TwoSides(project, browser, user=user, store=store) for browser, user in sides], store)
    shutil.rmtree(folder / "beds")


@pytest.mark.timeout(by_form(short=300, usual=1800, long=7200))
@settings(
    derandomize=by_form(short=True, usual=False, long=False),
    database=None,
    max_examples=EXAMPLES,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(
    trace=st.lists(
        st.tuples(
            st.sampled_from(("draw", "move", *BY_HAND, *BY_CHANCE)), st.integers(0, 1), st.integers(0, 80)
        ),
        min_size=8,
        max_size=60,
    )
)
def test_whatever_happens_the_journal_is_what_the_model_says_and_both_tabs_show_it(
    made_once: Path, browsers: list[BrowserSide], tmp_path: Path, trace: list[Step]
) -> None:
    with begun(made_once, browsers, tmp_path) as world:
        for step in trace:
            happen(world, step)
            world.check_conflicts()
        world.rest()
        project = world.tabs[0].project
        with project.read() as connection:
            for uid in all_caps(project.folder):
                entries = history(connection, uid)
                assert [entry.revision for entry in entries] == list(range(1, len(entries) + 1))
                assert [entry.after for entry in entries] == world.model[uid]
                assert {entry.id for entry in entries} <= world.seen
        live = {uid: states[-1] for uid, states in world.model.items() if states[-1] is not None}
        for tab in world.tabs:
            assert tab.there == live
            assert tab.look.live == live
            assert tab.look.status == tab.image.status
            assert tab.look.waiting == 0
