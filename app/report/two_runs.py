"""Two runs side by side in a report."""

from __future__ import annotations

from typing import Any

from fairyring.app.how_many import how_many
from fairyring.app.panels.markup import Markup, element
from fairyring.app.report.tables import number, percent, table
from fairyring.app.review.figures import Review
from fairyring.app.review.two_runs import side_by_side


def two_runs(first: Review, second: Review) -> Markup:
    """The figures of both, how much further off the second is, and the caps that changed most."""
    found = side_by_side(first, second)
    return element(
        "section",
        element("h2", "Two runs side by side"),
        table(
            ("", *(_name(found[which]) for which in ("first", "second"))),
            [
                ("CDR %", *(number(found[which]["cdr"]["mean"]) for which in ("first", "second"))),
                ("floor %", *(number(found[which]["floor"]["cdr_mean"]) for which in ("first", "second"))),
                ("px", *(number(found[which]["px"]["mean"], 2) for which in ("first", "second"))),
                ("error / diameter %", *(percent(found[w]["relative"]["mean"]) for w in ("first", "second"))),
                *(
                    (count, *(found[which][count] for which in ("first", "second")))
                    for count in ("matched", "missed", "extra")
                ),
            ],
        ),
        element("p", nearer_words(found)),
        table(
            ("Caps that changed most", "px before", "px after", "CDR % before", "CDR % after", "Floor %"),
            [
                (
                    f"{row['image']}, {row['name']}",
                    number(row["first"]["px"], 2),
                    number(row["second"]["px"], 2),
                    number(row["first"]["cdr"]),
                    number(row["second"]["cdr"]),
                    number(row["floor"]),
                )
                for row in found["changed"]
            ],
        ),
    )


def nearer_words(found: dict[str, Any]) -> str:
    """Which of the two is nearer, in a sentence."""
    of = found["difference"]
    if not of["both"] or of["px"] is None:
        return "No cap was found by both."
    px = of["px"]
    return (
        f"Of {how_many(of['both'], 'cap')} that both found, "
        f"{_name(found['first'])} is nearer in {of['first_nearer']} and "
        f"{_name(found['second'])} in {of['second_nearer']}: second less first "
        f"{px['mean']:+.2f} px ({px['low']:+.2f} to {px['high']:+.2f} in 95 of 100)."
    )


def _name(figures: dict[str, Any]) -> str:
    return figures.get("run", "latest")
