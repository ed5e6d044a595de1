"""The review as people see it: figures, groups of caps, a page of the images; every number is a link."""

from __future__ import annotations

from functools import partial

from fairyring.app.addresses import review_address
from fairyring.app.how_many import how_many
from fairyring.app.panels.counted import counted, titles_of
from fairyring.app.panels.gallery import BY_WORDS
from fairyring.app.panels.markup import EMPTY, Content, Markup, element
from fairyring.app.panels.review_found import USUAL, Review, Wanted
from fairyring.app.panels.status import run_badge
from fairyring.app.review.groups import NOT_KNOWN, words_of
from fairyring.app.review.unmeasured import why_unmeasured
from fairyring.app.review.what_cdr_is import ABOUT
from fairyring.storage.cap_groups import By, Group
from fairyring.storage.comparisons import ComparisonRow
from fairyring.storage.review_figures import Totals


def review_figures(review: Review) -> Markup:
    """What stands first: whose predictions, and the figures of all images."""
    if review.run is None or review.totals is None or not review.rows:
        return EMPTY
    return element(
        "div",
        element("div", run_badge(review.run), _stale_note(review.stale), class_="fr-line"),
        _totals(review.totals),
        None if review.stale else _why_unmeasured(review.totals, marked=review.marked),
        element("details", element("summary", "What CDR is"), element("p", ABOUT), class_="fr-quiet"),
        class_="fr-review",
    )


def review_page(review: Review, current: int | None, wanted: Wanted = USUAL) -> Markup:
    """Groups of caps, and a page of the images; or why there is nothing yet."""
    if review.run is None:
        return _hint("No predictions yet; there is nothing to compare with.")
    if not review.rows and review.stale:
        return _hint(f"Not compared with the predictions yet: {how_many(review.stale, 'image')}.")
    if not review.rows or review.totals is None:
        return _hint(
            "Correct some caps and mark their centres: then this compares them with the predictions."
        )
    last = review.first + len(review.rows)
    return element(
        "div",
        _groups(review, wanted.by),
        element(
            "table",
            _head(),
            element("tbody", *(_row(row, current) for row in review.rows)),
            class_="fr-list",
        ),
        element("div", f"{review.first + 1}–{last} of {how_many(review.total, 'image')}", class_="fr-quiet"),
        _untouched(review.untouched),
        _reports(current, wanted),
        class_="fr-review",
    )


def _reports(current: int | None, wanted: Wanted) -> Markup:
    """Links to the review as a page that can be printed, against the run that was chosen for the photo."""
    of = partial(review_address, "report.html", only_sure=wanted.only_sure, run=wanted.run and wanted.run.id)
    against = f" against {wanted.run.name}" if wanted.run else ""
    links = {f"Report of all images{against}": of()}
    if current is not None:
        links[f"Report of this image{against}"] = of(image=current)
    return element(
        "div",
        *(element("a", words, href=to, target="_blank") for words, to in links.items()),
        class_="fr-links",
    )


def _untouched(found: tuple[int, list[str]]) -> Markup | None:
    """Images that nobody has worked on; every prediction on them would count as extra."""
    count, names = found
    if not count:
        return None
    more = f" and {count - len(names)} more" if count > len(names) else ""
    told = f"{count} images that nobody has worked on count nowhere here"
    if count == 1:
        told = "1 image that nobody has worked on counts nowhere here"
    return element(
        "details", element("summary", told), element("p", ", ".join(names) + more), class_="fr-quiet"
    )


def _hint(sentence: str) -> Markup:
    return element("div", sentence, class_="fr-review fr-quiet")


def _stale_note(stale: int) -> Markup | None:
    if not stale:
        return None
    return element(
        "span", f"{stale} out of date", class_="fr-badge fr-warn", title="Edited since they were compared"
    )


def _why_unmeasured(found: Totals, *, marked: int) -> Markup | None:
    """Why there are dashes in place of figures."""
    if found.measured:
        return None
    counts = {"matched": found.matched, "missed": found.missed, "extra": found.extra, "marked": marked}
    return element("p", why_unmeasured(counts), class_="fr-quiet")


def _totals(found: Totals) -> Markup:
    shift = "–" if found.dx is None or found.dy is None else f"{found.dx:+.2f}, {found.dy:+.2f}"
    shown = (
        ("mean CDR", _mean_of_caps(_with_percent(found.cdr))),
        ("floor of marks", _mean_of_caps(_with_percent(found.floor))),
        ("Δx, Δy, px", _mean_of_caps(shift)),
        ("measured", counted("worst", found.measured)),
        ("matched", counted("matched", found.matched)),
        ("missed", counted("missed", found.missed)),
        ("extra", counted("extra", found.extra)),
    )
    return element(
        "dl",
        *(element("div", element("dd", value), element("dt", name)) for name, value in shown),
        class_="fr-totals",
        title=ABOUT,
    )


def _mean_of_caps(figure: str) -> Content:
    return figure if figure == "–" else counted("worst", figure)


def _groups(review: Review, by: By | None) -> Markup | None:
    if by is None:
        return None
    if not review.groups:
        what = BY_WORDS[by]
        return element("div", f"Of no image that counts the {what} is known yet.", class_="fr-quiet")
    titles = {"": None, "CDR %": 46, "Floor": 40, "Caps": 42, "Missed": 46, "Extra": 38}
    rows = (
        element(
            "tr",
            element("td", review.names_of_runs.get(value, words_of(value))),
            *(element("td", number, class_="fr-number") for number in _numbers_of(of, by, value)),
        )
        for value, of in review.groups.items()
    )
    return element(
        "table",
        titles_of(titles),
        element("tbody", *rows),
        class_="fr-list fr-groups",
        aria_label="Groups of caps",
    )


def _numbers_of(of: Totals, by: By, value: str) -> list[Markup]:
    """The figures of a group, each of which leads to its caps."""
    group = Group(by=by, value=None if value == NOT_KNOWN else value)
    return [
        counted("worst", _percent(of.cdr), group=group),
        counted("worst", _percent(of.floor), group=group),
        counted("worst", of.measured, group=group),
        counted("missed", of.missed, group=group),
        counted("extra", of.extra, group=group),
    ]


def _head() -> Markup:
    return titles_of({"Image": None, "CDR %": 46, "Floor": 40, "Worst": 42, "Missed": 46, "Extra": 38})


def _row(row: ComparisonRow, current: int | None) -> Markup:
    figures = row.comparison
    told = f"{how_many(figures.caps, 'cap')}, CDR {_percent(figures.cdr_mean)} %{_floor(row)}"
    told += "; edited since it was compared" if row.stale else ""
    image = Group(by="image", value=str(figures.image))
    numbers: tuple[Content, ...] = (
        _percent(figures.cdr_mean),
        _percent(figures.floor_mean),
        _percent(figures.cdr_worst),
        counted("missed", figures.missed, group=image),
        counted("extra", figures.extra, group=image),
    )
    name = element("span", row.file_name, class_="fr-ellipsis", title=row.file_name)
    return element(
        "tr",
        element("td", element("button", name, type="button", class_="fr-opens")),
        *(element("td", number, class_="fr-number") for number in numbers),
        class_="fr-stale" if row.stale else None,
        title=told,
        aria_current="true" if figures.image == current else None,
        **_opens(row),
    )


def _floor(row: ComparisonRow) -> str:
    floor = row.comparison.floor_mean
    return "" if floor is None else f" (the marks alone {floor:.3f} %)"


def _opens(row: ComparisonRow) -> dict[str, str | float | bool | None]:
    return {"data_fairyring_open": row.comparison.image, "data_fairyring_select": row.comparison.worst}


def _percent(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"


def _with_percent(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f} %"
