"""The messages between editor and server: JSON text frames over one WebSocket a tab.

``static/editor/protocol.js`` says the same in JSDoc types; a test compares the two.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

from fairyring.model.geometry.shapes import Circle, Fit, Polygon
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import Kind
from fairyring.storage.image_history import Reversal, Way
from fairyring.storage.records import (
    Annotation,
    Cap,
    Edit,
    ImageContents,
    Outcome,
    Outline,
    Prediction,
    Status,
    StatusEdit,
    Verdict,
)


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
    | ShowCaps
    | AskAgain
    | MarkedAgain
)


class FromServer(Struct, frozen=True, kw_only=True, tag_field="type"):
    """Base of everything the server may send."""


class Welcome(FromServer, frozen=True, tag="welcome"):
    """Answers Hello."""

    user: str
    project: str
    """A stable id: the browser keys its outbox by it."""


class Show(FromServer, frozen=True, tag="show"):
    """Show this image."""

    contents: ImageContents
    photo: str
    """URL of the photo."""
    select: str | None = None
    position: int = 0
    """Position in the filtered list, from 0."""
    count: int = 0
    ahead: list[str] = field(default_factory=list)
    """URLs of the photos likely to be shown next, fetched in advance."""


class Outcomes(FromServer, frozen=True, tag="outcomes"):
    """What became of edits this tab sent."""

    outcomes: list[Outcome]


class Working(FromServer, frozen=True, tag="working"):
    """Edits of this tab are being stored; said every few seconds for as long as that takes."""


class FoundCap(FromServer, frozen=True, tag="found_cap"):
    """Answers FindCap."""

    seq: int
    image: int
    visible: Outline | None
    """None where the network sees no cap."""
    score: float | None


class ComparedCap(Struct, frozen=True, kw_only=True):
    """A cap with the prediction that matches it; one of the two is None where there is no other."""

    annotation: str | None
    prediction: Prediction | None
    iou: float | None
    """IoU of the visible outlines."""
    cdr: float | None
    """CDR, percent (Eq. 10); None where the cap has no mark."""
    floor: float | None
    """CDR that the mark has by itself, percent."""


class Compared(FromServer, frozen=True, tag="compared"):
    """Answers Compare: all caps, those first that differ most."""

    image: int
    caps: list[ComparedCap]
    turned_down: list[Annotation]
    """What people have deleted of the predictions that match no cap."""


class MarkAgain(FromServer, frozen=True, tag="mark_again"):
    """Answers AskAgain: a piece of a photo, without any label, on which a cap is to be marked."""

    annotation: str
    photo: str
    """URL of the photo."""
    width: int
    """Of the photo, pixels."""
    box: tuple[float, float, float, float]
    """What to show of it: left, top, right, bottom."""
    at: tuple[float, float]
    """A point of the cap that is in sight, not its centre."""
    mirrored: bool
    """Left and right are to be exchanged."""
    mark: Literal["circle", "polygon"]
    """As the cap was marked before."""
    left: int
    """How many are due, with this one."""


class KeptAgain(FromServer, frozen=True, tag="kept_again"):
    """A second mark is on disk."""

    id: str


class StatusChanged(FromServer, frozen=True, tag="status"):
    """The status of the image on screen is another now."""

    image: int
    status: Status
    user: str


class Recalled(FromServer, frozen=True, tag="recalled"):
    """Answers Recall."""

    image: int
    way: Way
    change_set: int | None
    reversal: Reversal | None
    """None where there is nothing to take back."""


class Changed(FromServer, frozen=True, tag="changed"):
    """Somebody else (or a job) changed annotations of the image on screen."""

    image: int
    annotations: list[Annotation]
    user: str


class Predicted(FromServer, frozen=True, tag="predicted"):
    """New predictions of the image on screen by a run; they replace those of earlier runs."""

    image: int
    predictions: list[Prediction]


class Arc(Struct, frozen=True, kw_only=True):
    """A piece of a visible outline: own rim, hidden by a neighbour, cut off by the image border or something
    else, the rim of two caps that touch, or a hollow."""

    kind: Literal["visible", "hidden", "border", "contact", "concave"]
    points: list[float]
    """Points along the outline as a flat list x0, y0, x1, y1, …; pixels."""
    told: bool = False
    """Whether a person said so."""


class Fitted(FromServer, frozen=True, tag="fit"):
    """Answers Refit."""

    seq: int
    annotation: str
    fit: Fit
    arcs: list[Arc] = field(default_factory=list)
    """The visible outline cut up, in order; empty for a mark."""
    note: str = ""
    """How the fit came about, for the inspector; or why there is none."""
    mark: Literal["circle", "polygon"] | None = None
    """What to mark the cap with, by the paper's rule: a circle where it is regular, else its outline. None
    where it is marked already, or cannot be fitted."""


class JobProgress(FromServer, frozen=True, tag="progress"):
    """How far a job is whose line the panel shows; total 0 where that is not known."""

    job: int
    done: int
    total: int
    words: str


class Command(FromServer, frozen=True, tag="command"):
    """A panel button that the editor carries out: undo, fit, delete, accept_all, help, a tool's name …"""

    name: str


class Notice(FromServer, frozen=True, tag="notice"):
    """A sentence for the person at this tab."""

    text: str
    level: Literal["info", "warning", "error"] = "info"
    undo: int | None = None
    """The image whose last change of status a button beside the sentence takes back."""


Outgoing = (
    Welcome
    | Show
    | Outcomes
    | Working
    | StatusChanged
    | Recalled
    | Changed
    | Predicted
    | FoundCap
    | Compared
    | MarkAgain
    | KeptAgain
    | Fitted
    | JobProgress
    | Command
    | Notice
)
