import math

import pytest

from fairyring.model.errors import FairyringError
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Circle, Fit, fit_of_shape
from fairyring.storage.contents import (
    load_contents,
    load_prediction,
    load_predictions,
    load_run,
    load_version,
)
from fairyring.storage.derived import underived_of
from fairyring.storage.errors import StoreError
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import (
    NewPrediction,
    RunAsked,
    add_predictions,
    add_run,
    continued_run,
    latest_run,
    seen_by,
)
from fairyring.storage.records import Cap, Edit
from tests.support.stored import stored_runs


def predict(project, square, *, name="r", image=1, scores=(0.9, 0.5), **keys):
    def work(connection):
        run = add_run(connection, name=name, kind="simulated", **keys)
        new = [NewPrediction(visible=square, score=score, uid=str(score)) for score in scores]
        return run.id, add_predictions(connection, run_id=run.id, image_id=image, predictions=new)

    return project.write(work)


def test_a_run_keeps_what_made_it(project):
    run = project.write(
        lambda c: add_run(c, name="night", kind="network", weights="abc", settings={"grid": [40, 36]})
    )
    with project.read() as connection:
        assert load_run(connection, run.id) == latest_run(connection) == run
        assert stored_runs(connection) == [run]
    assert (run.name, run.kind, run.weights, run.settings) == ("night", "network", "abc", {"grid": [40, 36]})


def test_there_may_be_no_run(project):
    with project.read() as connection:
        assert latest_run(connection) is None
        assert load_run(connection, 1) is None
        assert load_prediction(connection, 1) is None


def test_predictions_are_kept_as_they_were_made(beds, square):
    whole = Circle(20.5, 20.5, 12.0)
    new = NewPrediction(visible=square, score=0.75, quality=0.5, fit=fit_of_shape(whole), extra={"a": [1]})

    def work(connection):
        run = add_run(connection, name="r", kind="network")
        return add_predictions(connection, run_id=run.id, image_id=1, predictions=[new])

    assert beds.write(work) == 1
    with beds.read() as connection:
        (stored,) = load_predictions(connection, 1)
        assert load_prediction(connection, stored.id) == stored
    assert (stored.visible, stored.score, stored.quality, stored.whole) == (square, 0.75, 0.5, whole)
    assert (stored.centre, stored.extra, stored.category) == ((20.5, 20.5), {"a": [1]}, "mushroom")


def test_the_document_shows_the_latest_run_that_saw_the_image(beds, square):
    predict(beds, square, name="first")
    predict(beds, square, name="second", scores=(0.25,))
    predict(beds, square, name="third", image=2)
    with beds.read() as connection:
        contents = load_contents(connection, 1)
    assert contents.run.name == "second"
    assert [p.score for p in contents.predictions] == [0.25]


def test_a_run_that_saw_nothing_in_an_image_is_still_the_latest(beds, square):
    predict(beds, square, name="first")
    predict(beds, square, name="second", scores=())
    with beds.read() as connection:
        contents = load_contents(connection, 1)
    assert (contents.run.name, contents.predictions) == ("second", [])


def test_an_older_run_that_adds_later_does_not_become_the_latest(beds, square):
    first, _ = predict(beds, square, name="first", scores=())
    predict(beds, square, name="second", scores=())
    new = [NewPrediction(visible=square, score=0.5)]
    beds.write(lambda c: add_predictions(c, run_id=first, image_id=1, predictions=new))
    with beds.read() as connection:
        assert load_contents(connection, 1).run.name == "second"


def test_the_same_predictions_again_add_nothing(beds, square):
    assert predict(beds, square, key="k") == (1, 2)
    assert predict(beds, square, key="k") == (1, 0)


@pytest.mark.parametrize("score", [math.nan, math.inf, -0.1, 1.1, True, None])
def test_a_score_lies_between_0_and_1(beds, square, score):
    with pytest.raises(StoreError, match="score lies between 0 and 1"):
        predict(beds, square, scores=(score,))


@pytest.mark.parametrize("quality", [math.nan, math.inf, -0.1, 1.1])
def test_a_quality_lies_between_0_and_1(beds, square, quality):
    def work(connection):
        run = add_run(connection, name="r", kind="network")
        new = NewPrediction(visible=square, score=0.5, quality=quality)
        return add_predictions(connection, run_id=run.id, image_id=1, predictions=[new])

    with pytest.raises(StoreError, match="quality lies between 0 and 1"):
        beds.write(work)


@pytest.mark.parametrize("visible", [[], [[0.0, 0.0, 1.0, 1.0]], [[0.0, 0.0, math.nan, 1.0, 2.0, 2.0]]])
def test_an_outline_that_cannot_be_used_stores_nothing(beds, visible):
    with pytest.raises(FairyringError):
        predict(beds, visible, scores=(0.5,))
    with beds.read() as connection:
        assert latest_run(connection) is None


def test_a_rejected_prediction_is_no_longer_shown_and_an_accepted_one_is(beds, square):
    predict(beds, square)

    def edit(number, annotation, base, cap):
        return Derived(edit=Edit(id=number, annotation=annotation, image=1, base=base, cap=cap))

    accepted, rejected = Cap(visible=square, prediction=1), Cap(visible=square, prediction=2)
    commit(
        beds, [edit("1", "a", 0, accepted), edit("2", "b", 0, rejected), edit("3", "b", 1, None)], user="ann"
    )
    with beds.read() as connection:
        assert [p.id for p in load_contents(connection, 1).predictions] == [1]
        assert [p.id for p in load_predictions(connection, 1)] == [1, 2]
    commit(beds, [edit("4", "b", 2, rejected)], user="ann")
    with beds.read() as connection:
        assert [p.id for p in load_contents(connection, 1).predictions] == [1, 2]


def test_new_predictions_make_figures_of_the_image_stale(beds, square):
    with beds.read() as connection:
        before = load_version(connection, 1)
    predict(beds, square)
    with beds.read() as connection:
        assert load_version(connection, 1) > before


def continued(project, *, image=None, **keys):
    of = {"name": "n", "weights": "abc", "settings": {"least": 0.3}} | keys

    def work(connection):
        run = continued_run(connection, RunAsked(**of))
        if image is not None:
            add_predictions(connection, run_id=run.id, image_id=image, predictions=[])
        return run

    return project.write(work)


def seen(project, *, weights="abc", least=0.3):
    with project.read() as connection:
        return seen_by(connection, RunAsked(name="n", weights=weights, settings={"least": least}))


def test_a_run_of_the_same_weights_and_settings_goes_on_until_another_is_made(beds, square):
    first = continued(beds, image=1)
    assert seen(beds) == {1}
    assert continued(beds, image=2, name="the name may change").id == first.id
    assert seen(beds) == {1, 2}
    assert seen(beds, weights="other") == seen(beds, least=0.5) == set()
    predict(beds, square, name="another", image=2)
    assert seen(beds) == set()
    again = continued(beds, image=1)
    assert again.id > first.id
    assert seen(beds) == {1}
    assert len({again.id, continued(beds, redo=True).id, continued(beds, settings={}).id}) == 3


def test_a_run_is_called_as_asked_and_goes_on_under_that_name_alone(beds):
    unnamed = continued(beds, image=1)
    named = continued(beds, image=1, called="new lamps")
    assert (named.name, named.id > unnamed.id) == ("new lamps", True)
    assert continued(beds, called="new lamps").id == named.id
    assert continued(beds).id == named.id
    other = continued(beds, called="newer lamps")
    assert other.id > named.id
    for keys, reason in (
        ({"called": "new lamps"}, "is called new lamps already"),
        ({"called": "newer lamps", "redo": True}, "without --redo it goes on"),
        ({"called": "newer lamps", "weights": "other"}, "is called newer lamps already"),
        ({"called": ""}, "printable characters"),
        ({"called": "two\nlines"}, "printable characters"),
    ):
        with pytest.raises(StoreError, match=reason):
            continued(beds, **keys)


def test_a_cap_without_a_whole_outline_keeps_the_reason(beds, square):
    new = NewPrediction(visible=square, score=0.5, fit=Fit(refusal="Too little of its rim is in sight."))

    def work(connection):
        run = add_run(connection, name="r", kind="network")
        add_predictions(connection, run_id=run.id, image_id=1, predictions=[new])
        return underived_of(connection, 1).predictions

    assert beds.write(work) == {}, "nobody needs to try again"


def test_what_a_model_held_to_be_likely_is_kept_for_caps_that_are_shown_or_became_annotations(beds, square):
    said = LikelyEllipse(
        parameters=(20.0, 21.0, 2.5, 0.1, 0.0),
        covariance=tuple(tuple(0.5 if i == k else 0.0 for i in range(5)) for k in range(5)),
    )

    def work(connection):
        for name, uids in (("old", ("a", "b")), ("new", ("c", "d"))):
            run = add_run(connection, name=name, kind="network")
            new = [
                NewPrediction(visible=square, score=0.9, uid=uid, likely_whole=None if uid == "d" else said)
                for uid in uids
            ]
            add_predictions(connection, run_id=run.id, image_id=1, predictions=new)
            if name == "old":
                accepted = load_predictions(connection, 1)[0]
        return accepted

    accepted = beds.write(work)
    with beds.read() as connection:
        assert load_contents(connection, 1).likely == [(square, said)]
    cap = Cap(visible=accepted.visible, prediction=accepted.id)
    commit(
        beds, [Derived(edit=Edit(id="e", annotation="cap", image=1, base=0, cap=cap), fit=Fit())], user="ann"
    )
    with beds.read() as connection:
        assert load_contents(connection, 1).likely == [(square, said)] * 2
