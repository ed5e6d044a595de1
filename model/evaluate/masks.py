"""Figures of predicted masks: average precision, precision and recall, and the success rate of caps.

All figures are fractions of 1, and None where there was nothing to count. Every cap that is not ignored
counts in AP, AR, P and R, whatever its size; S50, S75 and S50_strict are of caps from 30 px on, as the paper
misses smaller ones by design, and S50_small is of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from msgspec import Struct, to_builtins

from fairyring.model.coco.document import Document
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.average_precision import Matches, matches_of, precision_of
from fairyring.model.evaluate.outcomes import LEAST_SCORE, Flags, Outcomes, joined, outcomes_of_page
from fairyring.model.evaluate.pages import Page, Paged, pages_of, truth_of
from fairyring.model.evaluate.sizes import LARGE_AREA, MEDIUM_AREA, SMALL_PX

CAPITALS = {name: name.upper() for name in ("ap", "ap50", "ap75", "ar", "p", "r", "f1")} | {
    **{f"s{rest}": f"S{rest}" for rest in ("50", "75", "50_strict", "50_small")},
    "iou85": "IoU85",
}
"""Names of the figures as they are written, which are those of the literature."""


class GroupScores(Struct, frozen=True, kw_only=True, rename=CAPITALS):
    """Figures of a part of the caps."""

    ap: float | None
    """AP of the group's images; for sizes COCO's, which counts the caps under 30 px too."""
    s50: float | None
    s75: float | None
    s50_strict: float | None
    iou85: float | None
    """Share of the found caps whose outline is fine, and of those whose outline strays: of all sizes but in
    the groups by size. See ``Outcomes``."""
    excursion: float | None
    count: int
    """How many caps the success rates are shares of."""


class BestF1(Struct, frozen=True, kw_only=True, rename=CAPITALS):
    """The highest harmonic mean of precision and recall at IoU .5, and the least score that gives it."""

    f1: float | None
    score: float | None
    """Least score of the predictions that give it."""
    p: float | None
    r: float | None


class Counts(Struct, frozen=True, kw_only=True):
    """How many images, caps and predictions the figures are of."""

    images: int
    truths: int
    """True caps of all sizes, ignored ones left out."""
    small: int
    """True caps under 30 px."""
    ignored: int
    predictions: int
    """Predictions of all scores. The counts below are of scores ≥ .5, at IoU ≥ .5."""
    matched: int
    missed: int
    extra: int
    dropped: int
    """Unmatched predictions in ignored regions."""


class MaskScores(Struct, frozen=True, kw_only=True, rename=CAPITALS):
    """The figures of ``fairyring evaluate masks``."""

    ap: float | None
    ap50: float | None
    ap75: float | None
    ar: float | None
    p: float | None
    """Matched over matched and extra predictions of score ≥ .5, at IoU .5."""
    r: float | None
    """Matched true caps over all, the same way."""
    s50: float | None
    """Share of caps with a partner of score ≥ .5 at IoU ≥ .5, one to one."""
    s75: float | None
    s50_strict: float | None
    """The same without duplicates and without caps joined to others: ``Outcomes.alone``."""
    s50_small: float | None
    """S50 of the caps under 30 px (``Outcomes.diameter``)."""
    iou85: float | None
    """Share of the found caps of all sizes whose outline has an IoU of .85 or more."""
    excursion: float | None
    """Share of the found caps of all sizes whose outline strays somewhere by more than 2 px and 6 % of the
    diameter."""
    best_f1: BestF1
    score: float = LEAST_SCORE
    """Least score of the predictions that count in P, R and the success rates."""
    counts: Counts
    groups: dict[str, dict[str, GroupScores]]
    """By ``light`` and ``form`` (of images that state them), and by ``size``: s, m and l, visible areas below
    32² px, below 96² px and from there on, of caps from 30 px on; and ``under_30_px``."""


def evaluate_masks(predicted: Document, truth: Document) -> dict[str, Any]:
    """The figures of ``fairyring evaluate masks`` for two COCO documents or result lists.

    Only the truth's images count. Images are paired as by ``pages_of``. Raises FairyringError for what is
    not such a document.
    """
    return figures_of_masks(pages_of(predicted, truth_of(truth, masks=True, centres=False)))


def figures_of_masks(paged: Paged) -> dict[str, Any]:
    """The same for documents that were read with masks."""
    return to_builtins(score_masks(paged.pages)) | {"pairing": to_builtins(paged.pairing)}


def score_masks(pages: Sequence[Page]) -> MaskScores:
    """The same for images in memory, at least one; of their caps masks, scores, diameters and flags are read.

    Raises FairyringError for no image, scores that are not finite and caps without masks.
    """
    if not pages:
        raise FairyringError("There is no image to evaluate; the truth must list at least one.")
    by_page = [outcomes_of_page(page) for page in pages]
    matches = matches_of(pages)
    everything, precision = joined(by_page), precision_of(matches, range(len(pages)), by_size=True)
    tall = everything.diameter >= SMALL_PX
    overall = _group(everything, tall, outlines=everything.found, ap=precision.ap)
    counts = _counts(pages, everything)
    return MaskScores(
        ap=precision.ap,
        ap50=precision.ap50,
        ap75=precision.ap75,
        ar=precision.ar,
        p=_share(counts.matched, counts.matched + counts.extra),
        r=_share(counts.matched, counts.truths),
        s50=overall.s50,
        s75=overall.s75,
        s50_strict=overall.s50_strict,
        s50_small=_share(everything.found[~tall].sum(), int((~tall).sum())),
        iou85=overall.iou85,
        excursion=overall.excursion,
        best_f1=_best_f1(everything),
        counts=counts,
        groups={
            "light": _by(lambda page: page.light, matches, by_page),
            "form": _by(lambda page: page.form, matches, by_page),
            "size": _by_size(everything, tall, precision.ap_by_size),
        },
    )


def _group(outcomes: Outcomes, chosen: Flags, *, outlines: Flags, ap: float | None) -> GroupScores:
    """The figures of the ``chosen`` caps, and of those ``outlines`` that were found."""
    count = int(chosen.sum())
    judged = outcomes.found & outlines
    outline_count = int(judged.sum())
    return GroupScores(
        ap=ap,
        s50=_share(outcomes.found[chosen].sum(), count),
        s75=_share(outcomes.closely[chosen].sum(), count),
        s50_strict=_share(outcomes.alone[chosen].sum(), count),
        iou85=_share(outcomes.fine[judged].sum(), outline_count),
        excursion=_share(outcomes.strays[judged].sum(), outline_count),
        count=count,
    )


def _by(
    property_of: Callable[[Page], str | None], matches: Matches, by_page: Sequence[Outcomes]
) -> dict[str, GroupScores]:
    groups, pages = {}, matches.pages
    for value in sorted({value for page in pages if (value := property_of(page)) is not None}):
        places = [place for place, page in enumerate(pages) if property_of(page) == value]
        outcomes = joined([by_page[place] for place in places])
        ap = precision_of(matches, places).ap
        groups[value] = _group(outcomes, outcomes.diameter >= SMALL_PX, outlines=outcomes.found, ap=ap)
    return groups


def _by_size(outcomes: Outcomes, tall: Flags, precision: tuple[float | None, ...]) -> dict[str, GroupScores]:
    small, medium, large = precision
    below_medium, below_large = outcomes.area < MEDIUM_AREA, outcomes.area < LARGE_AREA
    sizes = {
        "s": (tall & below_medium, small),
        "m": (tall & below_large & ~below_medium, medium),
        "l": (tall & ~below_large, large),
        "under_30_px": (~tall, None),
    }
    return {name: _group(outcomes, chosen, outlines=chosen, ap=ap) for name, (chosen, ap) in sizes.items()}


def _counts(pages: Sequence[Page], outcomes: Outcomes) -> Counts:
    firm = outcomes.score >= LEAST_SCORE
    matched, truths = int((outcomes.right & firm).sum()), len(outcomes.found)
    return Counts(
        images=len(pages),
        truths=truths,
        small=int((outcomes.diameter < SMALL_PX).sum()),
        ignored=sum(cap.ignored for page in pages for cap in page.truths),
        predictions=len(outcomes.score),
        matched=matched,
        missed=truths - matched,
        extra=int((firm & ~outcomes.right & ~outcomes.dropped).sum()),
        dropped=int((firm & outcomes.dropped).sum()),
    )


def _best_f1(outcomes: Outcomes) -> BestF1:
    """The best F1 over all scores that occur; of several equally good ones the highest score."""
    counted = ~outcomes.dropped
    order = np.argsort(-outcomes.score[counted], kind="stable")
    scores, right = outcomes.score[counted][order], outcomes.right[counted][order]
    truths = len(outcomes.found)
    if not len(scores) or not truths:
        return BestF1(f1=None, score=None, p=None, r=None)
    # A threshold takes all predictions of one score or none.
    last = np.flatnonzero(np.diff(scores, append=-np.inf))
    hits, taken = np.cumsum(right)[last], last + 1
    f1 = 2 * hits / (taken + truths)
    best = int(f1.argmax())
    return BestF1(
        f1=float(f1[best]),
        score=float(scores[last[best]]),
        p=float(hits[best] / taken[best]),
        r=float(hits[best] / truths),
    )


def _share(part: int, whole: int) -> float | None:
    return float(part / whole) if whole else None
