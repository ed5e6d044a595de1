"""What reviewers said of images and of their caps, with the names by which these are found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection

from fairyring.storage.contents import load_annotations
from fairyring.storage.records import GivenVerdict, Image
from fairyring.storage.verdicts import all_verdicts


@dataclass(frozen=True, kw_only=True)
class Said:
    """A verdict and what it is about."""

    file_name: str
    verdict: GivenVerdict
    cap: int | None = None
    """Number of the cap on its image, from 1 on; None of a verdict on the image, or on a cap that is gone."""

    @property
    def about(self) -> str:
        """What it is about, on its image."""
        if self.verdict.annotation is None:
            return "the image"
        return "a cap that is gone" if self.cap is None else f"cap {self.cap}"


def said_of(connection: Connection, images: Sequence[Image]) -> list[Said]:
    """All that was said of these images and their caps, image by image, the first one first."""
    of_image: dict[int, list[GivenVerdict]] = {image.id: [] for image in images}
    for each in all_verdicts(connection):
        if each.image in of_image:
            of_image[each.image].append(each)
    found = []
    for image in images:
        numbers = _numbers_of_caps(connection, of_image[image.id])
        found += [
            Said(file_name=image.file_name, verdict=each, cap=numbers.get(each.annotation))
            for each in of_image[image.id]
        ]
    return found


def _numbers_of_caps(connection: Connection, verdicts: Sequence[GivenVerdict]) -> dict[str | None, int]:
    """The number of each cap by uid, of the image that these verdicts are of, where any is on a cap."""
    image = next((each.image for each in verdicts if each.annotation is not None), None)
    caps = [] if image is None else load_annotations(connection, image)
    return {cap.uid: nth for nth, cap in enumerate(caps, start=1)}


def entry_of(said: Said) -> dict[str, Any]:
    """One verdict as ``fairyring review --json`` has it, in the words of an export."""
    given = said.verdict
    of_cap = (
        {}
        if given.annotation is None
        else {"annotation": given.annotation, "cap": said.cap, "revision": given.revision}
    )
    told = {"says": given.says, "words": given.words, "by": given.user, "at": given.made_at}
    return {"image": said.file_name} | of_cap | told
