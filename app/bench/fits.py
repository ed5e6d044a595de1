"""Whether every way to ask for a whole outline gives the same, and how long each takes.

Predictions are accepted as they are, one at a time and all at once; caps are dragged. On a made crowd, and on
real photos as the shipped weights see them.
"""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import cv2

from fairyring.app.bench.crowd import add_crowd
from fairyring.app.bench.plain import inserted_at_once
from fairyring.app.bench.timing import Row, milliseconds, p95_row, row
from fairyring.app.caps.fitting import Fitting, Seen, known_statistics
from fairyring.app.caps.image_caps import ImageCaps, caps_of
from fairyring.app.caps.whole_outlines import derive_edits, refit
from fairyring.app.jobs.finders import network_of
from fairyring.app.jobs.predicting import predict_images
from fairyring.app.protocol import Refit
from fairyring.app.weights import require_weights
from fairyring.model.contour.silhouette import silhouette_of_outline
from fairyring.model.geometry.shapes import Fit
from fairyring.storage.choices import ImportFormat
from fairyring.storage.contents import load_contents
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.project import Project, create_project
from fairyring.storage.records import Accepted, Cap, Edit, Image, Outcome, Outline, Prediction

DRAGGED = 50
"""How many caps are dragged."""
STILL = 0.01
"""No centre may move by more than this without a cause, pixels."""


def fit_rows(*, quick: bool = False, real: Path | None = None) -> list[Row]:
    """Measures a made crowd and, if ``real`` is a folder of photos, each of these."""
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as name:
        folder = Path(name)
        with create_project(folder / "project") as project:
            add_crowd(project, folder / "crowd", **({"caps": 60} if quick else {}))
            if real is not None:
                _predict(project, real)
            with project.read() as connection:
                images = [line.image for line in list_images(connection, ImageFilter(), limit=1000).rows]
            return [row for image in images for row in _rows_of_image(project, image)]


def _predict(project: Project, photos: Path) -> None:
    import_paths(project, [photos], kind=ImportFormat.images, link=True)
    with project.read() as connection:
        wanted = list_images(connection, ImageFilter(predicted=False), limit=1000).rows
    predict_images(project, network_of(require_weights(project)), [line.image.id for line in wanted])


def _rows_of_image(project: Project, image: Image) -> list[Row]:
    with project.read() as connection:
        contents = load_contents(connection, image.id)
    predictions = contents.predictions
    if not predictions:
        return []
    name, outlines = f"{image.file_name}, {len(predictions)} caps", [p.visible for p in predictions]
    whole = _best(lambda: _fit_all(image, outlines))
    return [
        row(
            f"{name}: all fitted (findContours and fitEllipse)",
            whole,
            unit="ms",
            reference=_best(lambda: _fit_plainly(image, outlines)),
        ),
        p95_row(f"{name}: one dragged (all fitted)", _dragged(image, outlines), target=50, reference=[whole]),
        *_accepting(project, caps_of(contents), name),
    ]


def _accepting(project: Project, caps: ImageCaps, name: str) -> list[Row]:
    predictions, accepted = caps.predictions, [_accepted(caps.image, p) for p in caps.predictions]
    live = [_live(caps, edit) for edit in accepted]
    alone = [derive_edits(project, [edit], known=caps)[0].fit for edit in accepted]
    with project.read() as connection:
        fresh = caps_of(load_contents(connection, caps.image.id))
    start = time.perf_counter()
    outcomes = commit(project, derive_edits(project, accepted, known=fresh), user="bench")
    taken = 1e3 * (time.perf_counter() - start)
    stored = [_stored(outcome) for outcome in outcomes]
    plain = inserted_at_once(
        project.folder / f"plain{caps.image.id}.db", rows=len(accepted), payload="0" * 1000
    )
    return [
        row(f"{name}: all accepted, to disk (bare INSERTs)", taken, unit="ms", target=1500, reference=plain),
        row(
            f"{name}: accepted at once, a centre moves by",
            _apart(predictions, stored),
            unit="px",
            target=STILL,
        ),
        row(
            f"{name}: accepted alone, a centre moves by", _apart(predictions, alone), unit="px", target=STILL
        ),
        row(f"{name}: selected, a centre moves by", _apart(predictions, live), unit="px", target=STILL),
    ]


def _accepted(image: Image, prediction: Prediction) -> Edit:
    cap = Cap(visible=prediction.visible, category=prediction.category, prediction=prediction.id)
    number = f"bench-{prediction.id}"
    return Edit(id=number, annotation=number, image=image.id, base=0, cap=cap)


def _live(caps: ImageCaps, edit: Edit) -> Fit:
    assert edit.cap is not None, "it accepts a cap"
    return refit(caps, Refit(seq=0, image=edit.image, annotation=edit.annotation, cap=edit.cap)).fit


def _stored(outcome: Outcome) -> Fit:
    assert isinstance(outcome, Accepted), "nobody else is at work"
    return Fit(whole=outcome.annotation.whole, centre=outcome.annotation.centre)


def _apart(before: Sequence[Prediction], after: Sequence[Fit]) -> float:
    """The longest way of a centre; infinite where one was lost or found."""
    ways = [
        math.dist(old.centre, new.centre) if old.centre and new.centre else math.inf
        for old, new in zip(before, after, strict=True)
        if old.centre or new.centre
    ]
    return max(ways, default=0.0)


def _fit_all(image: Image, outlines: Sequence[Outline]) -> None:
    seen = [Seen(outline) for outline in outlines]
    Fitting(image, known_statistics(image)).reconstructions(seen, visible=seen)


def _fit_plainly(image: Image, outlines: Sequence[Outline]) -> None:
    for outline in outlines:
        mask = silhouette_of_outline(outline, width=image.width, height=image.height).mask
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        longest = max(contours, key=len, default=None)
        if longest is not None and len(longest) >= 5:
            cv2.fitEllipse(longest)


def _dragged(image: Image, outlines: Sequence[Outline]) -> list[float]:
    """Milliseconds that each of some caps takes, a corner of which is dragged by two pixels."""
    fitting, seen = Fitting(image, known_statistics(image)), [Seen(outline) for outline in outlines]
    fitting.reconstructions(seen, visible=seen)

    def drag(index: int) -> None:
        first, *others = outlines[index]
        moved = Seen([[first[0] + 2.0, *first[1:]], *others])
        fitting.reconstructions([moved], visible=[*seen[:index], moved, *seen[index + 1 :]])

    step = max(1, len(outlines) // DRAGGED)
    return milliseconds(drag, range(0, len(outlines), step))


def _best(work: Callable[[], object]) -> float:
    """Milliseconds of the best of three."""
    return min(milliseconds(lambda _: work(), range(3)))
