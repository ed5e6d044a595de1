"""What reviewers said of the image on screen and its caps, for the panel."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.panels.markup import Markup, element
from fairyring.storage.records import GivenVerdict, Says

WORDS: dict[Says, str] = {
    "approved": "approved",
    "rejected": "rejected",
    "sent_back": "sent back",
    "comment": "commented",
    "withdrawn": "withdrew the verdict",
}
MOST_LISTED = 30


def verdict_list(verdicts: Sequence[GivenVerdict]) -> Markup | None:
    """The verdicts, the last one first; None where there are none. Those on a cap lead to it."""
    if not verdicts:
        return None
    shown = list(reversed(verdicts))[:MOST_LISTED]
    left_out = len(verdicts) - len(shown)
    more = element("div", f"{left_out} earlier ones", class_="fr-quiet") if left_out else None
    return element("div", element("ol", *map(_row, shown), class_="fr-changes"), more)


def sentence_of(verdict: GivenVerdict) -> str:
    """Who said what and why, as text."""
    about = "" if verdict.annotation is None or verdict.says == "comment" else " a cap"
    told = f"{verdict.user} {WORDS[verdict.says]}{about}"
    return f"{told}: {verdict.words}" if verdict.words else f"{told}."


def open_demand(verdicts: Sequence[GivenVerdict]) -> str | None:
    """Why an image was last sent back or rejected; None where it was not, or was approved since."""
    said = [each for each in verdicts if each.annotation is None and each.says != "comment"]
    return sentence_of(said[-1]) if said and said[-1].says in ("sent_back", "rejected") else None


def moment(verdict: GivenVerdict) -> str:
    """When it was said, to the minute."""
    return f"{verdict.made_at[:16].replace('T', ' ')} UTC"


def _row(verdict: GivenVerdict) -> Markup:
    lead = None
    if verdict.annotation is not None:
        lead = element(
            "button",
            "Show the cap",
            type="button",
            data_fairyring_open=verdict.image,
            data_fairyring_select=verdict.annotation,
        )
    return element(
        "li",
        element("div", sentence_of(verdict)),
        element("div", element("span", moment(verdict), class_="fr-quiet"), lead, class_="fr-line"),
        data_fairyring_verdict=verdict.says,
    )
