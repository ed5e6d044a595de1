"""The caps of an image at one moment, as a tab or the store knows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fairyring.app.caps.fitting import Fitting, Seen, known_statistics, likely_by_outline
from fairyring.model.geometry.boxes import boxes_of_outlines
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.told_arcs import ToldArc, check_told_arcs
from fairyring.storage.records import Annotation, Cap, Image, ImageContents, Outline, Prediction


@dataclass(frozen=True)
class ImageCaps:
    """An image with all its caps, among which each is reconstructed and compared."""

    image: Image
    annotations: Mapping[str, Annotation]
    """Annotations by uid; deleted ones may be among them."""
    predictions: Sequence[Prediction]
    fitting: Fitting
    """Shared by all successive states of an image's caps."""

    @cached_property
    def visible(self) -> dict[str, Seen]:
        """What is visible of every cap: the live annotations, and the predictions nobody has touched.

        So a prediction that is accepted as it is changes nothing that is visible.
        """
        touched = {annotation.cap.prediction for annotation in self.annotations.values()}
        live = {uid: Seen(a.cap.visible, a.cap.told) for uid, a in self.annotations.items() if not a.deleted}
        return live | {key_of(p.id): Seen(p.visible) for p in self.predictions if p.id not in touched}

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """(n, 4), the boxes of all that is visible, in its order."""
        return boxes_of_outlines([seen.outline for seen in self.visible.values()])

    def visible_beside(self, uid: str, *, prediction: int | None) -> tuple[Seen, ...]:
        """What is visible of all caps but this one and the prediction it started from.

        Asked for again, as it is while a cap is dragged, it is the very same tuple.
        """
        own = (uid, key_of(prediction))
        if own not in self._beside:
            self._beside.clear()
            self._beside[own] = tuple(seen for key, seen in self.visible.items() if key not in own)
        return self._beside[own]

    @cached_property
    def _beside(self) -> dict[tuple[str, str], tuple[Seen, ...]]:
        """What was last asked for."""
        return {}

    @cached_property
    def _prediction(self) -> dict[int, Prediction]:
        return {prediction.id: prediction for prediction in self.predictions}

    def checked_outline(self, uid: str, cap: Cap) -> Outline:
        """The visible outline of a cap, checked: the very one known already where it is left as it was.

        Raises GeometryError.
        """
        before, said = self.annotations.get(uid), self._prediction.get(cap.prediction or 0)
        for known in (before and before.cap.visible, said and said.visible):
            if known and known == cap.visible:
                return known
        return check_outline(cap.visible, width=self.image.width, height=self.image.height)

    def checked_arcs(self, uid: str, cap: Cap, outline: Outline) -> Sequence[ToldArc]:
        """What is said of pieces of a checked outline: the very list known already where it is the same.

        Raises GeometryError.
        """
        before = self.annotations.get(uid)
        if before is not None and before.cap.told == cap.told and before.cap.visible == outline:
            return before.cap.told
        return check_told_arcs(cap.told, outline) if cap.told else ()

    def with_annotations(self, annotations: Mapping[str, Annotation]) -> ImageCaps:
        """The same image with other annotations."""
        return replace(self, annotations=annotations)


def caps_of(contents: ImageContents) -> ImageCaps:
    """The caps of an image as the store has them."""
    annotations = {annotation.uid: annotation for annotation in contents.annotations}
    likely = likely_by_outline(contents.likely)
    fitting = Fitting(contents.image, known_statistics(contents.image), likely)
    return ImageCaps(contents.image, annotations, contents.predictions, fitting)


def key_of(prediction: int | None) -> str:
    """The key of a prediction among outlines by uid; no uid looks like it."""
    return f"prediction {prediction}"
