"""Two annotators: how far the annotations agree with a second version, on this photo and on all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from sqlalchemy import Connection

from fairyring.app.editor_commands import COMMANDS
from fairyring.app.how_many import how_many
from fairyring.app.jobs.comparing import compare_with_run_work
from fairyring.app.live.reviewing import compare_photo_with
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.counted import counted, titles_of
from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.review.two_annotators import agreement_on_image
from fairyring.model.evaluate.agreement import Agreement
from fairyring.model.evaluate.kappa import Kappa, kappa_of
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import Kind
from fairyring.storage.compared_runs import lacking_comparison
from fairyring.storage.records import Run
from fairyring.storage.runs import all_runs, images_seen_by, require_run
from fairyring.storage.second_versions import SecondVersion, doubts, images_compared

NOBODY = "nobody else"
MOST_IMAGES = 200
"""So many images are listed."""
HOW = "Import what the second annotator labelled with --as second: it stands here then."


@dataclass(frozen=True, kw_only=True)
class Both:
    """What is known of the annotations and a second version of them."""

    versions: Sequence[str]
    """Names of all that were imported, the latest first."""
    second: Run | None = None
    here: Agreement | None = None
    """On the photo on screen; None where the second version holds nothing of it."""
    images: Sequence[SecondVersion] = ()
    doubtful: Kappa | None = None
    """Over all these images."""
    lacking: int = 0
    """How many images were not compared with it as they are now."""


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the choice of the second version and the tables of both."""
    gui = session.client.gui
    with gui.add_folder("Two annotators", expand_by_default=False):
        second = gui.add_dropdown(
            "Second annotator",
            [str(NOBODY)],
            hint=f"{COMMANDS['review'].keys[0]} draws this version beside the annotations",
        )
        shown = gui.add_html("")
        compare = gui.add_button("Compare all images with this version", visible=False)

    async def find() -> Both:
        image = session.image.id if session.image else None
        chosen = session.run_on_photo
        wanted = chosen.name if chosen and chosen.kind == "second" else None
        return await workspace.read(partial(_find, image=image, second=wanted))

    async def choose() -> None:
        chosen = second.value
        run = None if chosen == NOBODY else await workspace.read(lambda c: require_run(c, chosen))
        await compare_photo_with(workspace, session, run)
        session.redraw_at_once(("annotators", "beside"))

    async def start() -> None:
        if (run := (await find()).second) is not None:
            work = compare_with_run_work(workspace.project, run)
            workspace.start_job(session, f"Comparison with {run.name}", work)

    async def redraw() -> None:
        found = await find()
        options = (NOBODY, *found.versions)
        if tuple(second.options) != options:
            second.options = options
        second.value = found.second.name if found.second else NOBODY
        shown.content = annotators_page(found, session.image.id if session.image else None).html
        compare.visible = found.lacking > 0

    second.on_update(person_did(session, choose))
    compare.on_click(person_did(session, start))
    return redraw


def _find(connection: Connection, *, image: int | None, second: str | None) -> Both:
    versions = {run.name: run for run in reversed(all_runs(connection)) if run.kind == "second"}
    chosen = versions.get(second or "")
    if chosen is None:
        return Both(versions=list(versions))
    seen = {each.id for each in images_seen_by(connection, chosen.id)}
    return Both(
        versions=list(versions),
        second=chosen,
        here=agreement_on_image(connection, image, chosen) if image in seen and image is not None else None,
        images=images_compared(connection, chosen.id),
        doubtful=kappa_of(doubts(connection, chosen.id)),
        lacking=len(lacking_comparison(connection, chosen.id)),
    )


def annotators_page(found: Both, current: int | None) -> Markup:
    """What both have, what one alone has, and how far they agree: here, over all images, and on each."""
    if found.second is None:
        return element("div", HOW, class_="fr-review fr-quiet")
    return element(
        "div",
        None if found.here else element("div", f"{found.second.name} holds nothing of this photo."),
        _figures(found, found.second, current),
        _images(found.images, found.second, current),
        element("div", f"Not compared yet: {how_many(found.lacking, 'image')}.") if found.lacking else None,
        class_="fr-review fr-quiet",
    )


def _figures(found: Both, second: Run, current: int | None) -> Markup:
    """Both columns; their numbers lead to the caps, where these were compared as they are now."""
    here, images = found.here, found.images
    iou = _mean([(each.iou_mean, each.matched) for each in images])
    px = _mean([(each.px_mean, each.measured) for each in images])
    all_images = Group(by="run", value=str(second.id)) if images else None
    is_compared = any(each.image == current and not each.stale for each in images)
    this_photo = Group(by="run", value=str(second.id), image=current) if is_compared else None
    rows: Sequence[tuple[str, Kind, Content, Content]] = (
        ("matched", "matched", here.matched if here else "–", sum(each.matched for each in images)),
        ("missed by the second", "missed", here.only_first if here else "–", sum(e.missed for e in images)),
        (
            "only the second has (extra)",
            "extra",
            here.only_second if here else "–",
            sum(e.extra for e in images),
        ),
        ("IoU", "matched", _number(here.iou.mean if here and here.iou else None, 3), _number(iou, 3)),
        (
            "between centres, px",
            "worst",
            _number(here.px.mean if here and here.px else None, 2),
            _number(px, 2),
        ),
        ("kappa of doubtful", "doubtful", _kappa(here.doubtful if here else None), _kappa(found.doubtful)),
    )
    titles = {f"annotations and {second.name}": None, "this photo": 64, how_many(len(images), "image"): 64}
    lines = [
        element(
            "tr", *_cells((name, _counted(kind, of_photo, this_photo), _counted(kind, of_all, all_images)))
        )
        for name, kind, of_photo, of_all in rows
    ]
    return _table("Two annotators", titles, lines)


def _counted(kind: Kind, number: Content, group: Group | None) -> Content:
    return number if group is None or number == "–" else counted(kind, number, group=group)


def _images(images: Sequence[SecondVersion], second: Run, current: int | None) -> Markup | None:
    """Each image leads to the photo, with both versions drawn; its numbers to their caps."""
    if not images:
        return None
    rows = [_row_of_image(each, second, is_current=each.image == current) for each in images[:MOST_IMAGES]]
    left_out = len(images) - len(rows)
    more = (
        element("div", f"Not listed: {how_many(left_out, 'image')} on which they agree better.")
        if left_out
        else None
    )
    titles = {"Image": None, "Missed": 48, "Extra": 42, "IoU": 46, "px": 46}
    table = _table("Images of two annotators", titles, rows)
    return element("div", table, more)


def _row_of_image(each: SecondVersion, second: Run, *, is_current: bool) -> Markup:
    group = Group(by="run", value=str(second.id), image=each.image)
    numbers = (
        counted("missed", each.missed, group=group),
        counted("extra", each.extra, group=group),
        counted("matched", _number(each.iou_mean, 3), group=group),
        counted("worst", _number(each.px_mean, 2), group=group),
    )
    name = element("span", each.file_name, class_="fr-ellipsis", title=each.file_name)
    return element(
        "tr",
        element("td", element("button", name, type="button", class_="fr-opens")),
        *(element("td", number, class_="fr-number") for number in numbers),
        class_="fr-stale" if each.stale else None,
        aria_current="true" if is_current else None,
        data_fairyring_open=each.image,
        data_fairyring_run=second.id,
        data_fairyring_differences=True,
    )


def _table(name: str, titles: Mapping[str, int | None], rows: Sequence[Markup]) -> Markup:
    return element("table", titles_of(titles), element("tbody", *rows), class_="fr-list", aria_label=name)


def _cells(row: Sequence[Content]) -> list[Markup]:
    return [element("td", value, class_="fr-number" if nth else None) for nth, value in enumerate(row)]


def _mean(of: Sequence[tuple[float | None, int]]) -> float | None:
    """The mean over caps, from means of so many each."""
    known = [(mean, count) for mean, count in of if mean is not None and count]
    return sum(mean * count for mean, count in known) / sum(count for _, count in known) if known else None


def _number(value: float | None, decimals: int) -> str:
    return "–" if value is None else f"{value:.{decimals}f}"


def _kappa(of: Kappa | None) -> str:
    if of is None or not of.count:
        return "–"
    return "always alike" if of.kappa is None else f"{of.kappa:.2f}"
