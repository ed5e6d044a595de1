"""Which labelled photos are learnt from, which are validated on, and which are left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fairyring.app.jobs.training_labels import Labels
from fairyring.model.train.data import Example
from fairyring.model.train.split import split_by_source

FEWEST_TO_DIVIDE = 4
"""Least number of complete photos of which some are kept for validation."""
VALIDATION, TEST = ("val", "valid", "validation"), ("test",)
"""Values of an image's ``split`` that mean validation and test; all other images are for training."""
TESTED = "kept for tests"
UNFIT_TO_CHECK = "partly labelled and meant for validation"
NOT_ASKED = "meant for validation, for which others are given"


@dataclass(frozen=True, kw_only=True)
class Division:
    """The photos of a training."""

    learnt: list[Example]
    checked: list[Example]
    """Photos that are validated on."""
    left_out: Counter[str]
    """Numbers of photos that play no part, by the reason."""

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
            "left_out": dict(self.left_out),
        }

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
        left = ", ".join(f"{count} {reason}" for reason, count in sorted(self.left_out.items()))
        return (
            f"Learns from {' and '.join(parts)}; validates on {said['validated']}."
            + (f" Left out: {left}." if left else "")
        )  # fmt: skip


def divided(labels: Labels, validation: Labels | None, *, seed: int) -> Division:
    """Which examples are for training and which for validation; test images are in neither.

    Validated is ``validation`` where given, else what ``split`` names so, else a seeded three tenths of four
    complete photos and more. Only complete photos can be validated on: caps that nobody labelled yet would
    count as mistakes.
    """
    left_out = labels.left_out.copy()
    learnt: list[Example] = []
    checked: list[Example] = []
    for example, split in zip(labels.examples, labels.splits, strict=True):
        if split in TEST:
            left_out[TESTED] += 1
        elif split in VALIDATION:
            checked.append(example)
        else:
            learnt.append(example)
    if validation is not None:
        left_out[NOT_ASKED] += len(checked)
        left_out += validation.left_out
        checked = validation.examples
    elif not checked:
        learnt, checked = _shared_out(learnt, seed=seed)
    fit = [example for example in checked if example.complete]
    left_out[UNFIT_TO_CHECK] += len(checked) - len(fit)
    return Division(learnt=learnt, checked=fit, left_out=+left_out)


def _shared_out(examples: Sequence[Example], *, seed: int) -> tuple[list[Example], list[Example]]:
    """All examples, some of the complete ones for validation if there are enough of them."""
    complete = [example for example in examples if example.complete]
    if len(complete) < FEWEST_TO_DIVIDE:
        return list(examples), []
    # By the whole path: photos of two data sets may have one name.
    sides = split_by_source([example.path.as_posix() for example in complete], seed=seed)
    checked = {example.path for example, side in zip(complete, sides, strict=True) if side == "val"}
    return (
        [example for example in examples if example.path not in checked],
        [example for example in examples if example.path in checked],
    )


def _caps_in(examples: Sequence[Example]) -> int:
    return sum(len(example.caps) for example in examples)


def _photos(count: int, what: str) -> str:
    return f"{count} {what} photo{'' if count == 1 else 's'}"
