"""Files as other tools write them: taken with the right values, or named with what to do about them."""

import math

import pytest

from tests.strangers.bed import DISCS, Stranger
from tests.strangers.tried import ALL, tried


@pytest.mark.parametrize("stranger", ALL, ids=lambda stranger: f"{stranger.tool}: {stranger.what}")
def test_a_strangers_file_is_taken_as_it_is_or_named(stranger: Stranger, tmp_path):
    outcome = tried(stranger, tmp_path)
    assert stranger.said in "\n".join(outcome.said)
    assert (outcome.exit_code, outcome.photos, len(outcome.caps)) == (
        stranger.exit_code,
        stranger.photos,
        stranger.caps,
    )
    for nth, cap in enumerate(outcome.caps):
        x, y, r = DISCS[nth % 2]
        assert math.dist(cap.centre, (x, y)) < 0.6
        area = 4 * r * r if stranger.shape == "box" else math.pi * r * r
        assert cap.area == pytest.approx(area, rel=0.01)
        assert cap.is_doubtful == (stranger.shape == "box")


def test_there_are_forty_of_them():
    assert len(ALL) >= 40
