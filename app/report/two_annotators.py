"""Two annotators of the same photos in a report: over all of them, and photo by photo."""

from __future__ import annotations

from fairyring.app.how_many import how_many
from fairyring.app.panels.markup import Markup, element
from fairyring.app.report.tables import number, table
from fairyring.model.evaluate.agreement import Agreement
from fairyring.model.evaluate.bootstrap import Interval
from fairyring.model.evaluate.kappa import Kappa

NOT_TOLD = "a run holds no caps to be ignored; their file does"


def two_annotators(second: str, found: Agreement) -> Markup:
    """What both have, what one alone has, and how far outlines, centres and flags agree."""
    rows = [
        ("matched", found.matched, ""),
        (f"missed by {second}", found.only_first, ""),
        (f"only {second} has (extra)", found.only_second, ""),
        ("IoU", *_mean(found.iou)),
        ("between centres, px", *_mean(found.px)),
        ("between centres, CDR %", *_mean(found.cdr)),
        ("Cohen's kappa of doubtful", *_kappa(found.doubtful)),
        ("Cohen's kappa of ignored", *_kappa(found.ignored)),
    ]
    images = [
        (
            each.file_name,
            each.matched,
            each.only_first,
            each.only_second,
            number(each.iou),
            number(each.px, 2),
        )
        for each in found.images
    ]
    return element(
        "section",
        element("h2", f"Two annotators: the annotations and {second}"),
        table(("", how_many(len(found.images), "image"), "95 of 100"), rows),
        element("h3", "Image by image"),
        table(("Image", "Matched", "Missed", "Extra", "IoU", "px"), images),
    )


def _mean(of: Interval | None) -> tuple[str, str]:
    return ("–", "") if of is None else (number(of.mean), f"{number(of.low)} to {number(of.high)}")


def _kappa(of: Kappa) -> tuple[str, str]:
    if of.kappa is None:
        return "–", "both always say the same" if of.count else NOT_TOLD
    return number(of.kappa, 2), f"{number(of.low, 2)} to {number(of.high, 2)}"
