"""What the editor says to the server."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import Kind
from fairyring.storage.records import Cap, Edit, StatusEdit, Verdict
from fairyring.storage.reversals import Way


class FromEditor(Struct, frozen=True, kw_only=True, tag_field="type", forbid_unknown_fields=True):
    """Base of everything a browser may send."""


class Hello(FromEditor, frozen=True, tag="hello"):
    """First message: the one-time token viser put into this tab's page, and the image to come back to."""

    token: str
    image: int | None = None
    """The image shown before the connection broke; None lets the server choose."""


class Open(FromEditor, frozen=True, tag="open"):
    """Show this image; ``select`` an annotation and bring it into view."""

    image: int
    select: str | None = None


class Step(FromEditor, frozen=True, tag="step"):
    """Show the next (+1) or previous (-1) image of the list as filtered."""

    by: Literal[-1, 1]


class Edits(FromEditor, frozen=True, tag="edits"):
    """A change set or a piece of one, stored in one transaction; each edit gets an outcome of its own."""

    edits: list[Edit]
    statuses: list[StatusEdit] = field(default_factory=list)
    verdicts: list[Verdict] = field(default_factory=list)


class Refit(FromEditor, frozen=True, tag="refit"):
    """Asks for the whole outline of a cap as it is selected or dragged. Only the latest is answered."""

    seq: int
    image: int
    annotation: str
    cap: Cap


class FindCap(FromEditor, frozen=True, tag="find_cap"):
    """Asks for the cap that the network sees at points or in a box; with neither it only looks at the photo.

    Only the latest is answered.
    """

    seq: int
    image: int
    points: list[tuple[float, float]] = field(default_factory=list)
    wanted: list[bool] = field(default_factory=list)
    """Of each point, whether it is to be on the cap; the first is."""
    box: tuple[float, float, float, float] | None = None
    """Left, top, right, bottom."""
    besides: str | None = None
    """An annotation that hides nothing of it: the one that is to be put right."""


class Compare(FromEditor, frozen=True, tag="compare"):
    """Asks where annotations and predictions of an image differ, for a reviewer."""

    image: int


class CompareWith(FromEditor, frozen=True, tag="compare_with"):
    """Has photos compared with this run from now on."""

    run: int


class ShowCaps(FromEditor, frozen=True, tag="show_caps"):
    """Asks the panel for caps of all images: the worst, or those that a number counts."""

    kind: Kind
    group: Group | None
    """Only those of it; None for all."""


class AskAgain(FromEditor, frozen=True, tag="ask_again"):
    """Asks for a cap that the person at this tab is to mark again."""

    quiet: bool
    """Nothing is said where there is none."""


class MarkedAgain(FromEditor, frozen=True, tag="marked_again"):
    """The second mark of a cap, as it lies on the photo itself."""

    id: str
    """Chosen by the browser: the same id a second time changes nothing."""
    annotation: str
    mirrored: bool
    mark: Circle | Polygon


class Select(FromEditor, frozen=True, tag="select"):
    """Says what is selected, for the inspector."""

    annotations: list[str] = field(default_factory=list)
    predictions: list[int] = field(default_factory=list)


class Recall(FromEditor, frozen=True, tag="recall"):
    """Asks the journal what it takes to take something back."""

    image: int
    way: Way = "undo"
    change_set: int | None = None
    """One of the history of the image; None for what this person did last, or undid last."""


class Saving(FromEditor, frozen=True, tag="saving"):
    """How many edits of this tab wait for their acknowledgement, for the status line."""

    waiting: int


class Window(FromEditor, frozen=True, tag="window"):
    """The window that the panel is in; said at the beginning and when it changes."""

    dark: bool
    """The system asks for a dark page."""
    width: int
    """CSS pixels."""


class Tag(FromEditor, frozen=True, tag="tag"):
    """Says the light, the form and the split of an image; None for not known, or in no split."""

    image: int
    light: str | None = None
    form: str | None = None
    split: str | None = None


class Predict(FromEditor, frozen=True, tag="predict"):
    """Has the network look at an image."""

    image: int


class Cancel(FromEditor, frozen=True, tag="cancel"):
    """Stops a job that the person at this tab has started."""

    job: int


Incoming = (
    Hello
    | Open
    | Step
    | Edits
    | Refit
    | Select
    | Recall
    | Saving
    | Window
    | Tag
    | Predict
    | Cancel
    | FindCap
    | Compare
    | CompareWith
    | ShowCaps
    | AskAgain
    | MarkedAgain
)
