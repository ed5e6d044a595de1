"""The records that the store returns and accepts: plain data, free of SQL.

Outlines are lists of parts, each part a flat list ``[x0, y0, x1, y1, …]`` in continuous pixel
coordinates of the upright image (x right, y down, the centre of pixel i at i + 0.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, get_args

from msgspec import UNSET, Struct, UnsetType, field

from fairyring.model.coco.categories import DEFAULT_CATEGORY
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon
from fairyring.model.geometry.told_arcs import ToldArc

Outline = list[list[float]]
Shape = Circle | Ellipse
"""A whole outline, which goes on where the cap is hidden."""
Mark = Circle | Ellipse | Polygon
"""What a person placed. The browser places circles and polygons; ellipses come from imports."""
IMPORT = "import"
"""Who the journal names for what a file says, unless somebody stands by it."""
Status = Literal["new", "annotated", "approved"]
STATUSES: tuple[Status, ...] = get_args(Status)
Says = Literal["approved", "rejected", "sent_back", "comment", "withdrawn"]
"""What a verdict says: right; not to be used, and why; to be worked on again, and what is wrong; anything
else; that the verdict before it holds no longer, as somebody has set another status or undone it."""


def is_complete(status: Status) -> bool:
    """Whether people say that all caps of an image with this status are labelled."""
    return status != "new"


class Image(Struct, frozen=True, kw_only=True):
    """One photo of a project, upright."""

    id: int
    file_name: str
    """Base name, unique in the project."""
    path: str
    """POSIX path below the project's folder, or absolute where the image is linked."""
    width: int
    height: int
    sha256: str
    light: str | None = None
    form: str | None = None
    split: str | None = None
    status: Status = "new"
    statistics: dict[str, float] | None = None
    """What was measured on its masks, by which all its caps are fitted; None until that was done."""
    extra: dict[str, Any] = field(default_factory=dict)
    """Keys of an imported file that this version does not know, kept for the export."""


class Cap(Struct, frozen=True, kw_only=True):
    """What a person can say about one cap; an edit carries all of it."""

    visible: Outline
    mark: Mark | None = None
    ignored: bool = False
    doubtful: bool = False
    order: int | None = None
    """Overlap order; a cap of higher order lies in front."""
    category: str = DEFAULT_CATEGORY
    prediction: int | None = None
    """The prediction this cap started from."""
    arcs: list[ToldArc] | UnsetType = UNSET
    """What was said of pieces of the visible outline; left out where nothing was."""

    @property
    def told(self) -> Sequence[ToldArc]:
        """What was said of pieces of the visible outline."""
        return self.arcs or ()


class Annotation(Struct, frozen=True, kw_only=True):
    """A cap as people agreed on it, with what was derived from it."""

    uid: str
    """Chosen by whoever made it (the browser, an import), so that making it twice is harmless."""
    image: int
    revision: int
    cap: Cap
    deleted: bool = False
    whole: Shape | None = None
    """Whole outline, from the mark or else from the visible outline; None until it is worked out."""
    centre: tuple[float, float] | None = None
    centre_sd: tuple[float, float] | None = None
    """One standard deviation of the centre along x and y, pixels; None where it is not known."""
    extra: dict[str, Any] = field(default_factory=dict)


class Prediction(Struct, frozen=True, kw_only=True):
    """A cap as a model run saw it. Never edited."""

    id: int
    run: int
    image: int
    visible: Outline
    score: float
    quality: float | None = None
    """Expected IoU of the outline with the visible cap; None where nobody said."""
    category: str = DEFAULT_CATEGORY
    whole: Shape | None = None
    centre: tuple[float, float] | None = None
    extra: dict[str, Any] = field(default_factory=dict)


RunKind = Literal["import", "simulated", "network", "second"]
"""Whence a run comes; what is of kind ``second`` a second annotator labelled, and no model said."""


class Run(Struct, frozen=True, kw_only=True):
    """What made a set of predictions."""

    id: int
    name: str
    kind: RunKind
    made_at: str
    """UTC, ISO 8601."""
    weights: str | None = None
    """SHA-256 of the weights."""
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def second_annotator(self) -> str | None:
        """What the version of a second annotator is called; None of what a model or a method said."""
        return self.name if self.kind == "second" else None


class Edit(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """One change of one annotation, as the browser sends it."""

    id: str
    """Chosen by the browser: the same id a second time changes nothing."""
    annotation: str
    image: int
    base: int
    """The revision it was made on; 0 makes a new annotation."""
    cap: Cap | None
    """The whole cap as it should be; None deletes it."""
    change_set: str = ""
    """The change set it belongs to, chosen by the browser; empty for one of those that are stored with it."""
    takes_back: str = ""
    """The change set that its own takes back: an undo names what was done, a redo the undo."""


class StatusEdit(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """A change of what people say of an image, as the browser sends it."""

    id: str
    """Chosen by the browser: the same id a second time changes nothing."""
    image: int
    before: Status
    """The status it was made on."""
    after: Status
    change_set: str = ""
    takes_back: str = ""


class Verdict(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """What a reviewer says of an image or of one cap of it, as the browser sends it."""

    id: str
    """Chosen by the browser: the same id a second time changes nothing."""
    image: int
    annotation: str | None = None
    """The cap; None where it is about the image."""
    says: Says
    words: str = ""
    """The reason, or the comment."""
    change_set: str = ""


class GivenVerdict(Struct, frozen=True, kw_only=True):
    """A verdict as it is kept."""

    number: int
    """Grows with every verdict of the project."""
    image: int
    annotation: str | None
    revision: int | None
    """Of the cap when this was said of it; None where it is about the image."""
    says: Says
    words: str
    user: str
    made_at: str
    """UTC, ISO 8601."""


class Rules(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """How people work in a project."""

    approve_own: bool = False
    """Whether somebody may approve what they have labelled themselves."""
    repeat_share: float = 0.0
    """Share of the marked caps, 0 to 1, that people are asked to mark again."""
    repeat_seed: int = 1
    """Which caps these are follows from it."""


class Repeat(Struct, frozen=True, kw_only=True):
    """A cap that somebody marked twice; no label, and never exported as one."""

    id: str
    """Chosen by the browser: the same id a second time changes nothing."""
    annotation: str
    image: int
    user: str
    mirrored: bool
    """Whether the second mark was placed on a mirrored photo; it is kept as it lies on the photo itself."""
    first: Mark
    second: Mark
    size: str | None
    visibility: str | None


class SamplingPlan(Struct, frozen=True, kw_only=True):
    """What a random sample is to show of the images that it was drawn from."""

    lot: list[int]
    """Those images."""
    allowed: int
    """How many of the sample may be wrong for all the others to be approved."""
    tolerated: float
    """Share of wrong images, 0 to 1, of which a lot is not to hold more."""
    confidence: float
    """With which such a lot is found out, 0 to 1."""


class Queue(Struct, frozen=True, kw_only=True):
    """The images that a reviewer goes through, in this order."""

    number: int
    user: str
    title: str
    images: list[int]
    plan: SamplingPlan | None = None
    """Where the images are a random sample."""
    after_verdict: int = 0
    """Number of the last verdict that had been given when the queue was made."""


class Accepted(Struct, frozen=True, kw_only=True, tag="accepted", tag_field="outcome"):
    """The edit is on disk (now, or when it was first sent)."""

    edit: str
    annotation: Annotation


class Conflict(Struct, frozen=True, kw_only=True, tag="conflict", tag_field="outcome"):
    """The annotation has moved on since ``edit.base``; nothing was changed."""

    edit: str
    theirs: Annotation
    user: str
    """Who made the revision that is in the way."""


class Refused(Struct, frozen=True, kw_only=True, tag="refused", tag_field="outcome"):
    """The edit cannot be stored, and why, in a sentence for a person."""

    edit: str
    reason: str


class StatusStored(Struct, frozen=True, kw_only=True, tag="status", tag_field="outcome"):
    """The change of status, or the verdict, is on disk (now, or when it was first sent)."""

    edit: str
    image: int
    status: Status
    """As it is now."""


Outcome = Accepted | Conflict | Refused | StatusStored


class ImageContents(Struct, frozen=True, kw_only=True):
    """What is on one image, as the editor shows it."""

    image: Image
    annotations: list[Annotation]
    """Live annotations only."""
    predictions: list[Prediction]
    """Predictions of the latest run that saw it, without those that lie on annotations made otherwise."""
    run: Run | None
    unchecked: list[str] = field(default_factory=list)
    """Uids of annotations that a file said and no person has touched since."""
    likely: list[tuple[Outline, LikelyEllipse]] = field(default_factory=list)
    """Outlines that are shown or became annotations, and the whole ones that models held to be likely."""
