"""What the inspector says of what is selected."""

from __future__ import annotations

from fairyring.app.panels.inspector import error_facts
from fairyring.app.panels.several import several_facts
from fairyring.model.evaluate.centres import Pair, centre_error
from fairyring.model.geometry.shapes import Circle, Ellipse
from fairyring.storage.records import Annotation, Cap, Prediction

MARKED = Annotation(
    uid="a",
    image=1,
    revision=1,
    cap=Cap(visible=[], mark=Circle(0.0, 0.0, 15.0)),
    whole=Circle(0.0, 0.0, 15.0),
)
SAID = [
    Prediction(id=k, run=1, image=1, visible=[], score=score, whole=Ellipse(0.0, 0.0, 40.0, 10.0, 0.0))
    for k, score in ((1, 0.5), (2, 0.9))
]


def test_of_several_caps_it_says_how_many_of_what_they_are_and_their_means() -> None:
    html = several_facts([MARKED, *SAID]).html
    assert "3 selected" in html
    assert "1 annotation and 2 predictions" in html
    assert "mean 36.7 px, from 30.0 to 40.0" in html, "30, 40 and 40"
    assert "mean 0.70, from 0.50 to 0.90" in html


def test_it_offers_what_can_be_done_to_all_of_them() -> None:
    assert 'data-fairyring-command="accept"' in several_facts([MARKED, *SAID]).html
    assert 'data-fairyring-command="accept"' not in several_facts([MARKED, MARKED]).html
    for command in ("merge", "doubtful", "ignored", "delete"):
        assert f'data-fairyring-command="{command}"' in several_facts([MARKED, *SAID]).html


def test_no_cdr_is_shown_without_what_the_mark_is_off_by_itself() -> None:
    error = centre_error((10.0, 10.0), (12.0, 10.0), width=400, height=300, diameter=40.0)
    pair = Pair(truth=0, prediction=0, iou=0.9, error=error)
    facts = dict(error_facts(pair, floor=0.1234))
    assert facts["Floor"] == "the mark's own is 0.123 %"
    assert list(facts).index("Floor") == list(facts).index("CDR") + 1
    assert "not known" in str(dict(error_facts(pair, floor=None))["Floor"])
    assert "Floor" not in dict(error_facts(None, floor=0.1))
