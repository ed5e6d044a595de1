"""A tab and the real journal, with a line between them that breaks."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from fairyring.app.protocol import Edits, Recall, Recalled
from fairyring.storage.contents import load_annotation, load_annotations
from fairyring.storage.images import get_image
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Cap, Edit, Image, Status
from fairyring.storage.reversals import next_reversal, reversal_of
from fairyring.storage.statuses import set_status
from tests.support.browser_side import BrowserSide, Look
from tests.support.dying_store import DyingStore

IMAGE = 1


def triangle(x: float) -> list[list[float]]:
    """A visible outline whose right angle is at (x, 0)."""
    return [[x, 0.0, x + 9.0, 0.0, x, 9.0]]


@dataclass
class TwoSides:
    """Ada's tab shows the image; Bob changes it elsewhere."""

    project: Project
    browser: BrowserSide
    user: str = "Ada"
    store: DyingStore | None = None
    """Who stores what this tab sends; None where this process does."""
    look: Look = field(init=False)
    refused: list[str] = field(default_factory=list)
    up: bool = True
    _wire: deque[Edits | Recall] = field(default_factory=deque)
    _drawn: int = 0
    _edits_of_bob: int = 0

    def __post_init__(self) -> None:
        self._tell("forget")
        self.reconnect()

    def _tell(self, what: str, *how: Any) -> None:
        self.look = self.browser.tell(what, *how)
        self._wire.extend(self.look.sent)
        self.refused += self.look.refused

    def create(self, uid: str, x: float = 0.0) -> None:
        """Ada draws a cap."""
        self._tell("create", uid, Cap(visible=triangle(x)))

    def draw(self, x: float) -> None:
        """Ada draws a cap whose uid nobody has used."""
        self._drawn += 1
        self.create(f"drawn{self._drawn} by {self.user}", x)

    def become(self, **caps: Cap | None) -> None:
        """Ada changes caps in one step; None deletes."""
        self._tell("become", caps)

    def move(self, uid: str, x: float) -> None:
        """Ada moves a cap."""
        self.become(**{uid: self.replaced(uid, visible=triangle(x))})

    def replaced(self, uid: str, **fields: Any) -> Cap:
        """A cap as Ada sees it, with other fields."""
        cap = self.look.live[uid]
        return Cap(**({name: getattr(cap, name) for name in Cap.__struct_fields__} | fields))

    def do(self, what: str, *how: Any) -> None:
        """Ada undoes, redoes, takes a prediction, resolves a conflict."""
        self._tell(what, *how)

    def release(self, x: float) -> None:
        """Ada lets go at ``x`` what she took hold of; nothing where her page was loaded anew since."""
        self._tell("release", Cap(visible=triangle(x)))

    def say(self, status: Status) -> None:
        """Ada says something of the image."""
        self._tell("say", status)

    def serve(self, *, answer: bool = True) -> bool:
        """The server answers one message; the answer may get lost on its way. False when none has come."""
        if not self._wire:
            return False
        message = self._wire.popleft()
        if isinstance(message, Recall):
            self._recall(message)
            return True
        derived, before = [Derived(edit=edit) for edit in message.edits], self.image.status
        store = partial(commit, self.project) if self.store is None else self.store.commit
        outcomes = store(derived, statuses=message.statuses, user=self.user)
        if answer:
            if self.image.status != before:
                self._tell("status_changed", IMAGE, self.image.status, True)
            self._tell("receive", outcomes)
        return True

    def have_die(self, store: DyingStore, *, after_s: float) -> None:
        """The store is killed so many seconds after it was sent the next message; nobody hears of it."""
        message = self._wire[0] if self._wire else None
        if isinstance(message, Edits):
            derived = [Derived(edit=edit) for edit in message.edits]
            store.die_storing(derived, statuses=message.statuses, user=self.user, after_s=after_s)
        else:
            store.die()

    def next_edits(self) -> list[Edit]:
        """The edits of the message that the server answers next."""
        return list(self._wire[0].edits) if self._wire and isinstance(self._wire[0], Edits) else []

    def hear_status(self) -> None:
        """The server tells this tab that somebody else has changed the status."""
        if self.up:
            self._tell("status_changed", IMAGE, self.image.status, False)

    def _recall(self, asked: Recall) -> None:
        with self.project.read() as connection:
            found = (
                next_reversal(connection, IMAGE, user=self.user, way=asked.way)
                if asked.change_set is None
                else reversal_of(connection, IMAGE, asked.change_set)
            )
        self._tell(
            "recalled", Recalled(image=IMAGE, way=asked.way, change_set=asked.change_set, reversal=found)
        )

    def drain(self) -> None:
        """The server stores everything that is sent."""
        while self.serve():
            pass

    def cut(self) -> None:
        """The line breaks; what was on its way is lost."""
        self._wire.clear()
        self.up = False
        self._tell("disconnect")

    def reconnect(self) -> None:
        """The line is up again, and the server shows the image as it is now."""
        self._wire.clear()
        self.up = True
        self._tell("disconnect")
        self._tell("open", self.image, self.stored())
        self._tell("connect")

    def reload(self) -> None:
        """The page is loaded anew: nothing is left but what the browser has kept."""
        self._tell("reload")
        self.reconnect()

    def bob(self, uid: str, **fields: Any) -> None:
        """Bob changes a cap, or deletes it (``cap=None``); Ada's tab is told while its line is up."""
        now = self.annotation(uid)
        named = {name: getattr(now.cap, name) for name in Cap.__struct_fields__}
        cap = None if "cap" in fields else Cap(**(named | fields))
        self._edits_of_bob += 1
        edit = Edit(id=f"bob{self._edits_of_bob}", annotation=uid, image=IMAGE, base=now.revision, cap=cap)
        commit(self.project, [Derived(edit=edit)], user="Bob")

    def tell_of(self, uid: str) -> None:
        """The server tells Ada's tab what has become of a cap."""
        if self.up:
            self._tell("changed", IMAGE, [self.annotation(uid)])

    def bob_says(self, status: Status) -> None:
        """Bob says something of the image; Ada's tab is told while its line is up."""
        self.project.write(lambda connection: set_status(connection, IMAGE, status, user="Bob"))
        if self.up:
            self._tell("status_changed", IMAGE, status, False)

    @property
    def image(self) -> Image:
        """As it is stored."""
        with self.project.read() as connection:
            return get_image(connection, IMAGE)

    def annotation(self, uid: str) -> Annotation:
        """As it is stored."""
        with self.project.read() as connection:
            found = load_annotation(connection, uid)
        assert found is not None
        return found

    def stored(self) -> list[Annotation]:
        """All live annotations of the image."""
        with self.project.read() as connection:
            return load_annotations(connection, IMAGE)

    @property
    def there(self) -> dict[str, Cap]:
        """The caps as the store has them."""
        return {annotation.uid: annotation.cap for annotation in self.stored()}

    @property
    def agree(self) -> bool:
        """Whether both sides have the same caps and the same status."""
        return self.look.live == self.there and self.look.status == self.image.status
