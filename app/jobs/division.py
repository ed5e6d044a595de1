"""Which labelled photos are learnt from, which are validated on, and which are left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from fairyring.app.jobs.training_labels import Labels, LeftOut
from fairyring.model.splits import Split, split_called
from fairyring.model.train.data import Example
from fairyring.model.train.split import split_by_source

FEWEST_TO_DIVIDE = 4
"""Least number of complete photos of which some are kept for validation."""
TESTED = "kept for tests"
UNFIT_TO_CHECK = "partly labelled and meant for validation"
NOT_ASKED = "meant for validation, for which others are given"
COPIED = "copies of photos that are validated on or kept for tests"
LEARNT, CHECKED = "learnt", "validated"


@dataclass(frozen=True, kw_only=True)
class Division:
    """The photos of a training."""

    learnt: list[Example]
    checked: list[Example]
    """Photos that are validated on."""
    left_out: list[LeftOut]
    """Photos that play no part."""
    used: list[dict[str, Any]]
    """What ``labels.json`` says of the others, with what they are used for."""
    others: Counter[str]
    """Numbers of labels that are of no cap, by their category."""

    def figures(self) -> dict[str, Any]:
        """The numbers of photos and caps."""
        complete = [example for example in self.learnt if example.complete]
        partial = [example for example in self.learnt if not example.complete]
        return {
            "complete": len(complete),
            "caps": _caps_in(complete),
            "empty": sum(not example.caps for example in complete),
            "partial": len(partial),
            "caps_of_partial": _caps_in(partial),
            "validated": len(self.checked),
            "left_out": dict(Counter(each.why for each in self.left_out)),
            "other_categories": dict(self.others),
        }

    def record(self) -> list[dict[str, Any]]:
        """Every photo for ``labels.json``: what it is used for, or why it is not."""
        return [*self.used, *(each.entry | {"left_out": each.why} for each in self.left_out)]

    def __str__(self) -> str:
        """The figures in a sentence."""
        said = self.figures()
        parts = []
        if said["complete"] or not said["partial"]:
            empty = f", {said['empty']} without any" if said["empty"] else ""
            parts.append(f"{_photos(said['complete'], 'complete')} ({said['caps']} caps{empty})")
        if said["partial"]:
            parts.append(
                f"{_photos(said['partial'], 'partly labelled')} ({said['caps_of_partial']} caps; "
                "nothing is learnt outside them)"
            )
        left = ", ".join(f"{count} {reason}" for reason, count in sorted(said["left_out"].items()))
        others = ", ".join(f"{count} {name}" for name, count in sorted(self.others.items()))
        return (
            f"Learns from {' and '.join(parts)}; validates on {said['validated']}."
            + (f" Left out: {left}." if left else "")
            + (f" Labels that are of no cap: {others}." if others else "")
        )  # fmt: skip


def divided(labels: Labels, validation: Labels | None, *, seed: int) -> Division:
    """Which examples are for training and which for validation; test images are in neither.

    Validated is ``validation`` where given, else what ``split`` names so, else a seeded three tenths of those
    complete photos, four or more, of which nobody said that they are for training. Only complete photos can
    be validated on: caps that nobody labelled yet would count as mistakes. Photos of one file, by its
    SHA-256, are never on two sides: what is validated on or kept for tests teaches nothing, under whatever
    name.
    """
    left_out = list(labels.left_out)
    learnt: list[_Photo] = []
    checked: list[_Photo] = []
    kept: set[str] = set()
    for_training: set[str] = set()
    for photo, said in zip(_photos_of(labels), labels.splits, strict=True):
        split = split_called(said)
        if split is Split.test:
            left_out.append(LeftOut(entry=photo.entry, why=TESTED))
            kept.add(photo.file)
        elif split is Split.val:
            checked.append(photo)
        else:
            learnt.append(photo)
            for_training |= {photo.file} if split is Split.train else set()
    if validation is not None:
        left_out += [LeftOut(entry=photo.entry, why=NOT_ASKED) for photo in checked]
        left_out += validation.left_out
        checked = _photos_of(validation)
    elif not checked:
        learnt, checked = _shared_out(learnt, for_training=for_training, seed=seed)
    fit = [photo for photo in checked if photo.example.complete]
    left_out += [
        LeftOut(entry=photo.entry, why=UNFIT_TO_CHECK) for photo in checked if not photo.example.complete
    ]
    kept |= {photo.file for photo in fit}
    left_out += [LeftOut(entry=photo.entry, why=COPIED) for photo in learnt if photo.file in kept]
    learnt = [photo for photo in learnt if photo.file not in kept]
    return Division(
        learnt=[photo.example for photo in learnt],
        checked=[photo.example for photo in fit],
        left_out=left_out,
        used=[photo.entry | {"used": LEARNT} for photo in learnt]
        + [photo.entry | {"used": CHECKED} for photo in fit],
        others=labels.others + (validation.others if validation else Counter()),
    )


@dataclass(frozen=True)
class _Photo:
    """An example, and what ``labels.json`` says of it."""

    example: Example
    entry: dict[str, Any]

    @property
    def file(self) -> str:
        """What tells photos apart: the hash, else the whole path, as two data sets may share a name."""
        return self.example.sha256 or self.example.path.as_posix()


def _photos_of(labels: Labels) -> list[_Photo]:
    return [_Photo(*both) for both in zip(labels.examples, labels.entries, strict=True)]


def _shared_out(
    photos: Sequence[_Photo], *, for_training: Collection[str], seed: int
) -> tuple[list[_Photo], list[_Photo]]:
    """All photos, some of the complete ones for validation if there are enough of them."""
    complete = [photo.file for photo in photos if photo.example.complete and photo.file not in for_training]
    if len(set(complete)) < FEWEST_TO_DIVIDE:
        return list(photos), []
    sides = split_by_source(complete, seed=seed)
    checked = {file for file, side in zip(complete, sides, strict=True) if side == "val"}
    return (
        [photo for photo in photos if photo.file not in checked],
        [photo for photo in photos if photo.file in checked and photo.example.complete],
    )


def _caps_in(examples: Sequence[Example]) -> int:
    return sum(len(example.caps) for example in examples)


def _photos(count: int, what: str) -> str:
    return f"{count} {what} photo{'' if count == 1 else 's'}"
