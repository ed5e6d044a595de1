"""Which images a reviewer goes through, in which order, and when the rest may be approved."""

import pytest

from fairyring.app.panels.queue import progress_words, queue_line, size_words, waiting_words
from fairyring.app.review.queueing import EDITED, has_passed, ordered, rest_of, sampled, standing_of
from fairyring.storage.candidates import Candidate
from fairyring.storage.records import Queue, SamplingPlan, Says


def candidate(image, **figures):
    known = {"excess": None, "iou": None, "missed": 0, "extra": 0, "doubt": 0.0}
    known |= {"compared": True, "reopened": False}
    return Candidate(image=image, file_name=f"bed_{image}.png", **(known | figures))


FOUND = [
    candidate(1, excess=0.1, iou=0.9, missed=2, doubt=3.0),
    candidate(2, excess=0.4, iou=0.95, extra=5, reopened=True),
    candidate(3, missed=7, doubt=0.5),
    candidate(4, excess=-0.1, iou=0.8),
]


def test_each_order_begins_with_what_it_is_called_after():
    assert ordered(FOUND, "CDR over its floor") == [2, 1, 4, 3]
    assert ordered(FOUND, "least overlap") == [4, 1, 2, 3]
    assert ordered(FOUND, "most missed")[:2] == [3, 1]
    assert ordered(FOUND, "most extra")[0] == 2
    assert ordered(FOUND, "network least sure")[:2] == [1, 3]
    assert ordered(FOUND, "name") == [1, 2, 3, 4]
    assert ordered(FOUND, EDITED) == [2]


def test_a_sample_is_of_the_size_its_plan_asks_for_and_the_same_for_the_same_seed():
    lot = [candidate(number) for number in range(200)]
    plan = {"allowed": 0, "tolerated": 0.05, "confidence": 0.95}
    images, kept = sampled(lot, **plan, seed=3)
    assert images == sampled(lot, **plan, seed=3)[0] != sampled(lot, **plan, seed=4)[0]
    assert (
        len(images) == len(set(images)) == 47
    )  # scipy.stats.hypergeom(200, 11, 47).cdf(0) is 0.048, of 46 it is 0.052
    assert kept.lot == list(range(200))


def queue(**more):
    plan = SamplingPlan(lot=[1, 2, 3, 4], allowed=1, tolerated=0.1, confidence=0.9)
    return Queue(number=1, user="rev", title="random sample", images=[1, 2], plan=plan, **more)


def test_a_sample_passes_once_all_of_it_is_decided_and_not_too_much_is_wrong():
    assert not has_passed(queue(), standing_of(queue(), {1: "approved"}))
    assert has_passed(queue(), standing_of(queue(), {1: "approved", 2: "rejected"}))
    assert not has_passed(queue(), standing_of(queue(), {1: "sent_back", 2: "rejected"}))
    assert rest_of(queue()) == [3, 4]


def test_progress_is_told_with_the_agreement_and_its_interval():
    decisions: dict[int, Says] = {12: "rejected"}
    decisions.update((number, "approved") for number in range(1, 12))
    at = Queue(number=1, user="rev", title="name", images=list(range(1, 201)))
    # statsmodels.stats.proportion.proportion_confint(11, 12, method="wilson") is 0.646 to 0.985.
    assert progress_words(standing_of(at, decisions)) == "12 of 200 done, agreement 92 % (65 to 99 %)"
    assert "0 of 200 done" in queue_line(at, standing_of(at, {}), waiting=0).html
    told = queue_line(at, standing_of(at, decisions), waiting=0).html
    assert "✓ 11 approved · ✗ 1 rejected" in told
    assert "sent back" not in told


@pytest.mark.parametrize(
    ("count", "words"),
    [(0, "No image waits for a review."), (1, "1 image waits for"), (3, "3 images wait for")],
)
def test_how_many_wait_is_a_sentence(count, words):
    assert waiting_words(count).startswith(words)


def test_how_many_images_fit_a_queue_is_said_before_it_is_begun():
    assert "No image fits this queue" in size_words(0, sample=None).html
    assert "1 image fits" in size_words(1, sample=None).html
    assert "47 of 200 images have to be looked at" in size_words(200, sample=47).html
