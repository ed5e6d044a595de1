"""An image with its caps, at one moment, as a tab or the store knows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fairyring.app.caps.nearby import NOWHERE, Boxes, around
from fairyring.model.geometry.shapes import polygon_of_shape
from fairyring.storage.records import Annotation, Image, ImageContents, Outline, Prediction


@dataclass(frozen=True)
class Scene:
    """What a cap is worked out and judged among."""

    image: Image
    annotations: Mapping[str, Annotation]
    """By uid; deleted ones may be among them."""
    predictions: Sequence[Prediction]
    boxes: Boxes = field(default_factory=Boxes)

    @cached_property
    def visible(self) -> dict[str, Outline]:
        """What is visible of every cap: the live annotations, and the predictions nobody has touched."""
        touched = {annotation.cap.prediction for annotation in self.annotations.values()}
        live = {uid: a.cap.visible for uid, a in self.annotations.items() if not a.deleted}
        return live | {key_of(p.id): p.visible for p in self.predictions if p.id not in touched}

    @cached_property
    def _places(self) -> np.ndarray:
        """(n, 4), the boxes of ``visible``."""
        boxes = [self.boxes.of(outline) or NOWHERE for outline in self.visible.values()]
        return np.array(boxes).reshape(-1, 4)

    def near(self, uid: str, outline: Outline, *, prediction: int | None, reach: float) -> list[Outline]:
        """What is visible around a cap with this outline, without itself and the prediction it started from.

        Of others whose box touches its own, widened on all sides by ``reach`` times the longer side.
        """
        left, top, right, bottom = around(outline, reach=reach)
        (x0, y0, x1, y1), keys = self._places.T, list(self.visible)
        touching = np.flatnonzero((x0 <= right) & (x1 >= left) & (y0 <= bottom) & (y1 >= top))
        own = (uid, key_of(prediction))
        return [self.visible[keys[place]] for place in touching if keys[place] not in own]


def scene_of(contents: ImageContents) -> Scene:
    """The scene as the store knows it."""
    annotations = {annotation.uid: annotation for annotation in contents.annotations}
    return Scene(contents.image, annotations, contents.predictions)


def key_of(prediction: int | None) -> str:
    """The name of a prediction among outlines; no uid looks like it."""
    return f"prediction {prediction}"


def covered_by(annotation: Annotation) -> Outline:
    """What a cap covers: what is visible of it, else all of a mark placed without an outline."""
    if annotation.cap.visible or annotation.whole is None:
        return annotation.cap.visible
    return [polygon_of_shape(annotation.whole)]
