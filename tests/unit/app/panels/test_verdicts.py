"""What a reviewer demands of an image is told until it is approved or the demand is withdrawn."""

from fairyring.app.panels.verdicts import open_demand
from fairyring.storage.records import GivenVerdict, Says


def said(says: Says, words: str = "", *, annotation: str | None = None) -> GivenVerdict:
    return GivenVerdict(
        number=1,
        image=1,
        annotation=annotation,
        revision=None,
        says=says,
        words=words,
        user="Rev",
        made_at="",
    )


def test_the_last_demand_stands_whatever_is_commented_or_said_of_caps_since():
    back = said("sent_back", "One is missing")
    since = [said("comment", "soon"), said("rejected", "no cap", annotation="cap")]
    assert open_demand([said("approved"), back, *since]) == "Rev sent back: One is missing"


def test_an_approval_or_a_withdrawal_ends_it():
    back = said("sent_back", "One is missing")
    assert open_demand([back, said("approved")]) is None
    assert open_demand([back, said("withdrawn")]) is None
    assert open_demand([]) is None
