"""What a file of labels holds, before anybody has looked at the images: the same for every format."""

from __future__ import annotations

from typing import Any

from msgspec import Struct, field

from fairyring.storage.records import Cap, Shape


class Problem(Struct, frozen=True):
    """Something that could not be taken as it stands."""

    file: str
    where: str
    """For example ``annotation 12``; empty where it is the whole file."""
    reason: str

    def __str__(self) -> str:
        return ": ".join(part for part in (self.file, self.where, self.reason) if part)


class FoundCap(Struct, frozen=True, kw_only=True):
    """One cap. Its outline is as the file has it, polygons or an RLE: not yet checked against the image."""

    where: str
    cap: Cap
    score: float | None = None
    marked: bool = True
    """A person placed what stands for the centre; False for what a machine worked out."""
    whole: Shape | None = None
    centre: tuple[float, float] | None = None
    uid: str | None = None
    rle: dict[str, Any] | None = None
    """In place of the visible outline, which is decoded once the photo's size is known."""
    extra: dict[str, Any] = field(default_factory=dict)


class FoundImage(Struct, frozen=True, kw_only=True):
    """One image a file speaks of, and its caps."""

    where: str
    file_name: str
    """As written; only its base name counts."""
    width: int | None = None
    height: int | None = None
    light: str | None = None
    form: str | None = None
    split: str | None = None
    extra: dict[str, Any] = field(default_factory=dict)
    caps: list[FoundCap] = field(default_factory=list)


class Found(Struct, frozen=True, kw_only=True):
    """All of one file. ``problems`` are those of items left out of it."""

    file: str
    images: list[FoundImage]
    problems: list[Problem]
    categories: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Unknown keys of each category."""
