"""What reviewers said, in a report: verdicts with their reasons, and comments, with who and when."""

from __future__ import annotations

from collections.abc import Sequence

from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.verdicts import WORDS, moment
from fairyring.app.report.tables import table
from fairyring.app.review.said import Said


def said_table(said: Sequence[Said], *, of_one: bool) -> Markup:
    """All that was said, image by image, the first one first; nothing of it was ever changed.

    ``of_one``: it is of one image, which the rows need not name.
    """
    if not said:
        return element("p", "Nobody has said anything yet.", class_="quiet")
    head = (*(() if of_one else ("Image",)), "Of", "Says", "Reason or comment", "Who", "When")
    rows = [
        (
            *(() if of_one else (each.file_name,)),
            each.about,
            WORDS[each.verdict.says],
            each.verdict.words,
            each.verdict.user,
            moment(each.verdict),
        )
        for each in said
    ]
    return element("div", table(head, rows), class_="words")
