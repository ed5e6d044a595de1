"""Whole outlines and centres: from a cap's mark where it has one, else from what is visible of it.

Neighbours matter only where they touch, so a single cap is reconstructed among those around it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

from app.gateway.messages import Fit, Refit
from app.nearby import keys_near
from model.contour.marks import whole_of_mark
from model.contour.reconstruct import Reconstruction, reconstruct
from model.errors import FairyringError
from model.geometry import Circle, Polygon
from storage import derived
from storage.documents import load_annotations, load_document, load_predictions
from storage.errors import StoreError
from storage.images import get_image
from storage.journal import Derived
from storage.project import Project
from storage.records import Annotation, Document, Edit, Image, Mark, Outline, Shape

Key = TypeVar("Key")
Progress = Callable[[int, int, str], None]
REACH = 0.5
"""How far around a cap, as a share of its size, others still count as its neighbours."""


@dataclass(frozen=True)
class Whole:
    """What was worked out for a cap, or why there is nothing."""

    shape: Shape | None
    note: str

    @property
    def centre(self) -> tuple[float, float] | None:
        """Of the whole outline."""
        return (self.shape.cx, self.shape.cy) if self.shape else None


def whole_of(visible: Outline, mark: Mark | None, *, image: Image, around: Mapping[str, Outline]) -> Whole:
    """The whole outline of one cap; ``around`` holds the visible outlines of the image's other caps."""
    if mark is not None:
        return _from_mark(mark)
    neighbours = [around[key] for key in keys_near(visible, around, reach=REACH)]
    return _wholes([visible, *neighbours], [0], image=image)[0]


def outlines_of(document: Document, annotations: Mapping[str, Annotation]) -> dict[str, Outline]:
    """What is visible of every cap: the live annotations, and the predictions nobody has touched."""
    touched = {annotation.cap.prediction for annotation in annotations.values()}
    live = {uid: a.cap.visible for uid, a in annotations.items() if not a.deleted}
    return live | {_key(p.id): p.visible for p in document.predictions if p.id not in touched}


def refit(document: Document, annotations: Mapping[str, Annotation], request: Refit) -> Fit:
    """Answers a refit: the whole outline of a cap as it is being dragged."""
    cap, around = request.cap, outlines_of(document, annotations)
    around.pop(request.annotation, None)
    around.pop(_key(cap.prediction), None)
    whole = whole_of(cap.visible, cap.mark, image=document.image, around=around)
    return Fit(
        seq=request.seq,
        annotation=request.annotation,
        whole=whole.shape,
        centre=whole.centre,
        note=whole.note,
    )


def derive_edits(project: Project, edits: Sequence[Edit]) -> list[Derived]:
    """Works out whole outlines and centres for a change set, as the image stands with the whole set in it."""
    images: dict[int, Image] = {}
    caps: dict[int, dict[str, Outline]] = {}
    with project.read() as connection:
        for image_id in {edit.image for edit in edits}:
            with suppress(StoreError):
                document = load_document(connection, image_id)
                images[image_id] = document.image
                caps[image_id] = outlines_of(document, {a.uid: a for a in document.annotations})
    for edit in edits:
        if edit.image in caps:
            _enter(caps[edit.image], edit)
    return [_derive(edit, images.get(edit.image), caps.get(edit.image, {})) for edit in edits]


def fill_in(
    project: Project, image_ids: Sequence[int] | None = None, *, progress: Progress | None = None
) -> int:
    """Works out every whole outline and centre that is missing; returns how many were stored.

    ``image_ids`` None means the whole project. Each image is stored by itself, so that a later call goes on
    where this one was stopped.
    """
    if image_ids is None:
        with project.read() as connection:
            image_ids = derived.images_with_underived(connection)
    stored = 0
    for done, image_id in enumerate(image_ids):
        if progress is not None:
            progress(done, len(image_ids), "Finding whole outlines and centres")
        stored += _fill_in_image(project, image_id)
    return stored


def _fill_in_image(project: Project, image_id: int) -> int:
    with project.read() as connection:
        lacking = derived.underived_of(connection, image_id)
        image = get_image(connection, image_id)
        people = {a.uid: a for a in load_annotations(connection, image_id)}
        model = {p.id: p for p in load_predictions(connection, image_id)}
    marks = {uid: mark for uid in lacking.annotations if (mark := people[uid].cap.mark) is not None}
    unmarked = [uid for uid in lacking.annotations if uid not in marks]
    wholes = {uid: _from_mark(mark) for uid, mark in marks.items()}
    wholes |= _wholes_among({uid: a.cap.visible for uid, a in people.items()}, unmarked, image=image)
    seen = _wholes_among({key: p.visible for key, p in model.items()}, lacking.predictions, image=image)
    annotation_fits = [
        derived.AnnotationFit(uid=uid, revision=people[uid].revision, fit=_stored(whole))
        for uid, whole in wholes.items()
    ]
    prediction_fits = [derived.PredictionFit(id=key, fit=_stored(whole)) for key, whole in seen.items()]
    return project.write(
        lambda connection: derived.store_derived(
            connection, image_id, annotations=annotation_fits, predictions=prediction_fits
        )
    )


def _wholes_among(caps: Mapping[Key, Outline], wanted: Sequence[Key], *, image: Image) -> dict[Key, Whole]:
    place = {key: index for index, key in enumerate(caps)}
    found = _wholes(list(caps.values()), [place[key] for key in wanted], image=image)
    return dict(zip(wanted, found, strict=True))


def _wholes(caps: Sequence[Outline], wanted: Sequence[int], *, image: Image) -> list[Whole]:
    found = reconstruct(caps, width=image.width, height=image.height, only=wanted)
    return [_from_reconstruction(one) for one in found]


def _from_reconstruction(found: Reconstruction) -> Whole:
    return Whole(found.whole, found.refusal or found.why)


def _from_mark(mark: Mark) -> Whole:
    try:
        shape = whole_of_mark(mark)
    except (FairyringError, ValueError):
        shape = None
    if shape is None:
        return Whole(None, "The mark determines no outline; place more points around the cap.")
    if isinstance(mark, Polygon):
        return Whole(shape, "ellipse fitted to the marked polygon")
    return Whole(shape, "the marked circle" if isinstance(mark, Circle) else "the marked ellipse")


def _stored(whole: Whole) -> derived.Fit:
    return derived.Fit(
        whole=whole.shape, centre=whole.centre, refusal=whole.note if whole.shape is None else None
    )


def _derive(edit: Edit, image: Image | None, caps: Mapping[str, Outline]) -> Derived:
    if edit.cap is None or image is None:
        return Derived(edit=edit)
    around = {key: outline for key, outline in caps.items() if key != edit.annotation}
    fit = _stored(whole_of(edit.cap.visible, edit.cap.mark, image=image, around=around))
    return Derived(edit=edit, whole=fit.whole, centre=fit.centre, refusal=fit.refusal)


def _enter(caps: dict[str, Outline], edit: Edit) -> None:
    caps.pop(edit.annotation, None)
    if edit.cap is not None:
        caps.pop(_key(edit.cap.prediction), None)
        caps[edit.annotation] = edit.cap.visible


def _key(prediction: int | None) -> str:
    return f"prediction {prediction}"
