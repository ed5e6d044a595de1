"""Why there is no centre to measure: in the words of who looks for one."""

from __future__ import annotations

from collections.abc import Mapping

from fairyring.app.how_many import how_many
from fairyring.model.evaluate.matching import LEAST_IOU


def why_unmeasured(counts: Mapping[str, int], *, second: str | None = None) -> str:
    """Says why no cap was measured, from how many are ``marked``, ``matched``, ``missed`` and ``extra``.

    ``second``: the second annotator's version that stands for predictions, None for a model's.
    """
    caps, predictions = counts["matched"] + counts["missed"], counts["matched"] + counts["extra"]
    if not caps:
        return "No cap is labelled, so there is nothing to measure."
    if not counts["marked"]:
        return "No cap is marked, so there is no centre to measure from."
    if not predictions:
        told = f"{second} labels nothing" if second else "Nothing is predicted"
        return f"{told}, so there is nothing to measure."
    if not counts["matched"]:
        return (
            f"None of {how_many(counts['marked'], 'marked cap')} matches one of "
            f"{how_many(predictions, 'prediction')} (IoU of {LEAST_IOU:g} or more), "
            "so there is nothing to measure."
        )
    return (
        f"None of {how_many(counts['marked'], 'marked cap')} matches a prediction with a centre "
        f"(IoU of {LEAST_IOU:g} or more); what matches has no mark."
    )
