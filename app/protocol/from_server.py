"""What the server says to the editor."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

from fairyring.model.geometry.shapes import Fit
from fairyring.storage.records import (
    Annotation,
    ImageContents,
    Outcome,
    Outline,
    Prediction,
    Status,
)
from fairyring.storage.reversals import Reversal, Way


class FromServer(Struct, frozen=True, kw_only=True, tag_field="type"):
    """Base of everything the server may send."""


class Welcome(FromServer, frozen=True, tag="welcome"):
    """Answers Hello."""

    user: str
    project: str
    """A stable id: the browser keys its outbox by it."""
    look_ahead: bool = True
    """Whether to ask for a first look at a photo as soon as somebody stays on it."""


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
    second: str | None
    """What the second annotator's version is called that is compared; None where a model's is."""


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
