"""The contents of a file of labels before the photos are read, the same for every format."""

from __future__ import annotations

from typing import Any

from msgspec import Struct, field

from fairyring.storage.records import Cap, Shape, Status


class Problem(Struct, frozen=True):
    """An item of a file that could not be taken as it stands."""

    file: str
    where: str
    """The item, for example ``annotation 12``; empty where it is the whole file."""
    reason: str

    def __str__(self) -> str:
        return ": ".join(part for part in (self.file, self.where, self.reason) if part)


class FoundCap(Struct, frozen=True, kw_only=True):
    """A cap in a file. Its outline is as the file has it, not yet checked against the image."""

    where: str
    cap: Cap
    score: float | None = None
    quality: float | None = None
    """Expected IoU of its outline with the visible cap, as a machine said."""
    marked: bool = True
    """Whether a person placed its shape and centre, rather than a machine."""
    whole: Shape | None = None
    centre: tuple[float, float] | None = None
    centre_sd: tuple[float, float] | None = None
    uid: str | None = None
    id: int | None = None
    """Its number in the file."""
    file: str = ""
    tells_ignored: bool = False
    """Whether the file says that it is to be ignored or not; else it may just not know of that."""
    tells_doubtful: bool = False
    """Likewise."""
    is_mask: bool = False
    """Whether its outline was traced from a mask."""
    is_box: bool = False
    """Whether it is only a box, whose rim is to be corrected."""
    rle: dict[str, Any] | None = None
    """An RLE in place of the visible outline; it is decoded once the photo's size is known."""
    extra: dict[str, Any] = field(default_factory=dict)


class FoundCategory(Struct, frozen=True, kw_only=True):
    """A category that a file lists, whether or not a cap is of it."""

    id: int | None = None
    """Its number in the file."""
    extra: dict[str, Any] = field(default_factory=dict)
    """Keys that are not known."""


class FoundImage(Struct, frozen=True, kw_only=True):
    """An image in a file, with its caps."""

    where: str
    file_name: str
    """File name as written, perhaps with folders before it; empty in a list of results."""
    id: int | None = None
    """Its number in the file."""
    called: int | str | None = None
    """What a list of results calls it by: the number of an image, or a photo's name without its ending."""
    width: int | None = None
    height: int | None = None
    light: str | None = None
    form: str | None = None
    split: str | None = None
    status: Status | None = None
    """None where the file does not say."""
    one_of_several: bool = False
    """Whether another image of the file has this base name, so that the folders before it decide."""
    has_photo: bool = False
    """Whether the photo itself lies in the file."""
    extra: dict[str, Any] = field(default_factory=dict)
    caps: list[FoundCap] = field(default_factory=list)


class Found(Struct, frozen=True, kw_only=True):
    """All of one file. ``problems`` are those of the items that were left out."""

    file: str
    images: list[FoundImage]
    problems: list[Problem]
    categories: dict[str, FoundCategory] = field(default_factory=dict)
    """By name, in the order of the file."""
    polygons: int = 0
    """How many polygons of labelme there are, which may be marks as well."""
    labels: int = 0
    """How many labels the file holds, whether or not they can be used."""
    all_scored: bool = False
    """Whether each of them carries a score, as what a machine said does."""

    @property
    def is_results(self) -> bool:
        """Whether it is a list of results, which lists no images."""
        return any(image.called is not None for image in self.images)
