"""Which photos are learnt from, which are validated on, and what is said of it."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from fairyring.app.jobs.division import divided
from fairyring.app.jobs.training_labels import Labels, LeftOut
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
    return Labels(
        examples=examples,
        splits=splits,
        entries=[{"file_name": example.path.name} for example in examples],
        record={},
        left_out=[
            LeftOut(entry={}, why=why) for why, count in (left_out or {}).items() for _ in range(count)
        ],
        others=Counter(),
    )


def of_files(labelled: Labels, files: list[str]) -> Labels:
    """The same labels, the photos' files with these hashes."""
    examples = [replace(example, sha256=file) for example, file in zip(labelled.examples, files, strict=True)]
    return replace(labelled, examples=examples)


@pytest.mark.parametrize(
    ("splits", "learnt", "checked"),
    [
        ([None] * 3, 3, 0),
        ([None] * 10, 7, 3),
        (["train"] * 5 + ["val"] * 2 + ["test"], 5, 2),
        ([None] * 4 + ["test"] * 6, 3, 1),
        (["train"] * 9 + ["test"], 9, 0),
        (["train"] * 3 + [None] * 4, 6, 1),
        (["training"] * 5 + ["valid"] * 2 + ["Test"], 5, 2),
    ],
)
def test_images_are_divided_by_their_split_else_seven_to_three(
    splits: list[str | None], learnt: int, checked: int
) -> None:
    some = labels(splits)
    photos = divided(some, None, seed=0)
    assert (len(photos.learnt), len(photos.checked)) == (learnt, checked)
    assert not {e.path for e in photos.learnt} & {e.path for e in photos.checked}
    given = divided(some, of_files(labels([None] * 3), ["a", "b", "c"]), seed=0)
    assert len(given.checked) == 3
    assert len(given.learnt) == sum(split in (None, "train", "training") for split in splits)


def test_a_copy_of_a_photo_for_training_is_not_validated_on() -> None:
    files = ["a", "b", "c", "d", "a"]
    for seed in range(20):
        photos = divided(of_files(labels([None] * 4 + ["train"]), files), None, seed=seed)
        assert "a" not in {e.sha256 for e in photos.checked}
        assert [e.sha256 for e in photos.learnt].count("a") == 2


def test_a_photo_labelled_in_part_is_learnt_from_and_never_validated_on() -> None:
    photos = divided(labels([None] * 10, partial=6), None, seed=0)
    assert sum(not example.complete for example in photos.learnt) == 6
    assert (len(photos.learnt), len(photos.checked)) == (9, 1)
    meant = divided(labels(["val"] * 3 + [None], partial=2), None, seed=0)
    assert (len(meant.learnt), len(meant.checked)) == (1, 1)
    assert meant.figures()["left_out"] == {"partly labelled and meant for validation": 2}
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


def test_copies_of_a_photo_are_on_one_side_whichever_the_seed() -> None:
    files = ["a", "b", "c", "d", "a", "b", "e", "f", "a", "g"]
    for seed in range(20):
        photos = divided(of_files(labels([None] * 10), files), None, seed=seed)
        assert photos.checked
        assert not {e.sha256 for e in photos.learnt} & {e.sha256 for e in photos.checked}
        assert len(photos.learnt) + len(photos.checked) == 10


def test_a_copy_of_what_is_checked_on_or_tested_with_teaches_nothing_under_any_name() -> None:
    files = ["a", "b", "c", "a", "c"]
    photos = divided(of_files(labels([None, None, "val", "test", None]), files), None, seed=0)
    assert [e.path.name for e in photos.learnt] == ["1.jpg"]
    assert photos.figures()["left_out"] == {
        "kept for tests": 1,
        "copies of photos that are validated on or kept for tests": 2,
    }
    given = divided(of_files(labels([None] * 2), ["a", "b"]), of_files(labels([None]), ["b"]), seed=0)
    assert [e.path.name for e in given.learnt] == ["0.jpg"]


def test_photos_of_unknown_hashes_are_told_apart_by_their_paths() -> None:
    photos = divided(labels([None, "val"]), None, seed=0)
    assert (len(photos.learnt), len(photos.checked), photos.left_out) == (1, 1, [])


def test_the_record_says_of_every_photo_what_it_was_used_for_or_why_not() -> None:
    some = labels([None, None, "val", "test"], left_out={"without labels": 1})
    said = divided(of_files(some, ["a", "b", "b", "c"]), None, seed=0).record()
    assert [(e.get("file_name"), e.get("used"), e.get("left_out")) for e in said] == [
        ("0.jpg", "learnt", None),
        ("2.jpg", "validated", None),
        (None, None, "without labels"),
        ("3.jpg", None, "kept for tests"),
        ("1.jpg", None, "copies of photos that are validated on or kept for tests"),
    ]
