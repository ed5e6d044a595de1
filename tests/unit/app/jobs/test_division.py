"""Which photos are learnt from, which are validated on, and what is said of it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from fairyring.app.jobs.division import divided
from fairyring.app.jobs.training_labels import Labels
from fairyring.model.train.data import Example

CAP = [[10.0, 10.0, 30.0, 10.0, 30.0, 30.0]]


def labels(
    splits: list[str | None], *, partial: int = 0, caps: int = 2, left_out: dict[str, int] | None = None
) -> Labels:
    """As many photos, the first ``partial`` of them labelled in part."""
    examples = [
        Example(path=Path(f"{nth}.jpg"), width=90, height=60, caps=[CAP] * caps, complete=nth >= partial)
        for nth in range(len(splits))
    ]
    return Labels(examples=examples, splits=splits, record={}, left_out=Counter(left_out or {}))


@pytest.mark.parametrize(
    ("splits", "learnt", "checked"),
    [
        ([None] * 3, 3, 0),
        ([None] * 10, 7, 3),
        (["train"] * 5 + ["val"] * 2 + ["test"], 5, 2),
        ([None] * 4 + ["test"] * 6, 3, 1),
    ],
)
def test_images_are_divided_by_their_split_else_seven_to_three(
    splits: list[str | None], learnt: int, checked: int
) -> None:
    some = labels(splits)
    photos = divided(some, None, seed=0)
    assert (len(photos.learnt), len(photos.checked)) == (learnt, checked)
    assert not {e.path for e in photos.learnt} & {e.path for e in photos.checked}
    given = divided(some, labels([None] * 3), seed=0)
    assert len(given.checked) == 3
    assert len(given.learnt) == sum(split in (None, "train") for split in splits)


def test_a_photo_labelled_in_part_is_learnt_from_and_never_validated_on() -> None:
    photos = divided(labels([None] * 10, partial=6), None, seed=0)
    assert sum(not example.complete for example in photos.learnt) == 6
    assert (len(photos.learnt), len(photos.checked)) == (9, 1)
    meant = divided(labels(["val"] * 3 + [None], partial=2), None, seed=0)
    assert (len(meant.learnt), len(meant.checked)) == (1, 1)
    assert meant.left_out == {"partly labelled and meant for validation": 2}
    given = divided(labels([None]), labels([None] * 3, partial=1), seed=0)
    assert len(given.checked) == 2


def test_one_line_says_how_much_is_learnt_and_what_is_left_out() -> None:
    some = labels([None] * 5 + ["val"] * 2 + ["test"], partial=3, left_out={"without labels": 4})
    assert str(divided(some, None, seed=0)) == (
        "Learns from 2 complete photos (4 caps) and 3 partly labelled photos (6 caps; nothing is learnt "
        "outside them); validates on 2. Left out: 1 kept for tests, 4 without labels."
    )
    assert str(divided(labels([None], partial=1, caps=1), None, seed=0)) == (
        "Learns from 1 partly labelled photo (1 caps; nothing is learnt outside them); validates on 0."
    )
    assert str(divided(labels([None], caps=0), None, seed=0)) == (
        "Learns from 1 complete photo (0 caps, 1 without any); validates on 0."
    )
