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
    marked: bool = True
    """Whether a person placed its shape and centre, rather than a machine."""
    whole: Shape | None = None
    centre: tuple[float, float] | None = None
    centre_sd: tuple[float, float] | None = None
    uid: str | None = None
    id: int | None = None
    """Its number in the file."""
    file: str = ""
    is_mask: bool = False
    """Whether its outline was traced from a mask."""
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
    """File name as written; only its base name counts."""
    id: int | None = None
    """Its number in the file."""
    width: int | None = None
    height: int | None = None
    light: str | None = None
    form: str | None = None
    split: str | None = None
    status: Status | None = None
    """None where the file does not say."""
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
