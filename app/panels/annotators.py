"""Two annotators: how far the annotations agree with a second version, on this photo and on all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from sqlalchemy import Connection

from fairyring.app.editor_commands import COMMANDS
from fairyring.app.jobs.comparing import compare_with_run_work
from fairyring.app.live.reviewing import compare_photo_with
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.review.two_annotators import agreement_on_image
from fairyring.model.evaluate.agreement import Agreement
from fairyring.model.evaluate.kappa import Kappa, kappa_of
from fairyring.storage.compared_runs import lacking_comparison
from fairyring.storage.records import Run
from fairyring.storage.runs import all_runs, images_seen_by, require_run
from fairyring.storage.second_versions import SecondVersion, doubts, images_compared

NOBODY = "nobody else"
MOST_IMAGES = 200
"""So many images are listed."""
HOW = "Import what the second annotator labelled with --as predictions: it stands here then."


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
        wanted = chosen.name if chosen and chosen.kind == "import" else None
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
    versions = {run.name: run for run in reversed(all_runs(connection)) if run.kind == "import"}
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
        _figures(found, found.second.name),
        _images(found.images, current),
        element("div", f"{found.lacking} images are not compared yet.") if found.lacking else None,
        class_="fr-review fr-quiet",
    )


def _figures(found: Both, second: str) -> Markup:
    here, images = found.here, found.images
    iou = _mean([(each.iou_mean, each.matched) for each in images])
    px = _mean([(each.px_mean, each.measured) for each in images])
    rows: Sequence[tuple[str, Content, Content]] = (
        ("matched", here.matched if here else "–", sum(each.matched for each in images)),
        ("missed by the second", here.only_first if here else "–", sum(each.missed for each in images)),
        (
            "only the second has (extra)",
            here.only_second if here else "–",
            sum(each.extra for each in images),
        ),
        ("IoU", _number(here.iou.mean if here and here.iou else None, 3), _number(iou, 3)),
        ("between centres, px", _number(here.px.mean if here and here.px else None, 2), _number(px, 2)),
        ("kappa of doubtful", _kappa(here.doubtful if here else None), _kappa(found.doubtful)),
    )
    titles = (f"annotations and {second}", "this photo", _counted_images(len(images)))
    return _table("Two annotators", titles, [element("tr", *_cells(row)) for row in rows])


def _images(images: Sequence[SecondVersion], current: int | None) -> Markup | None:
    """Each image leads to the photo, with both versions drawn."""
    if not images:
        return None
    rows = [
        element(
            "tr",
            element("td", element("span", each.file_name, class_="fr-ellipsis", title=each.file_name)),
            *(
                element("td", value, class_="fr-number")
                for value in (
                    each.missed,
                    each.extra,
                    _number(each.iou_mean, 3),
                    _number(each.px_mean, 2),
                )
            ),
            class_="fr-stale" if each.stale else None,
            aria_current="true" if each.image == current else None,
            tabindex=0,
            role="button",
            data_fairyring_open=each.image,
            data_fairyring_differences=True,
        )
        for each in images[:MOST_IMAGES]
    ]
    left_out = len(images) - len(rows)
    more = (
        element("div", f"{left_out} images on which they agree better are not listed.") if left_out else None
    )
    table = _table("Images of two annotators", ("Image", "Missed", "Extra", "IoU", "px"), rows)
    return element("div", table, more)


def _table(name: str, titles: Sequence[str], rows: Sequence[Markup]) -> Markup:
    head = (element("th", title, class_="fr-number" if nth else None) for nth, title in enumerate(titles))
    return element(
        "table",
        element("thead", element("tr", *head)),
        element("tbody", *rows),
        class_="fr-list",
        aria_label=name,
    )


def _cells(row: Sequence[Content]) -> list[Markup]:
    return [element("td", value, class_="fr-number" if nth else None) for nth, value in enumerate(row)]


def _counted_images(count: int) -> str:
    return "1 image" if count == 1 else f"{count} images"


def _mean(of: Sequence[tuple[float | None, int]]) -> float | None:
    """The mean over caps, from means of so many each."""
    known = [(mean, count) for mean, count in of if mean is not None and count]
    return sum(mean * count for mean, count in known) / sum(count for _, count in known) if known else None


def _number(value: float | None, decimals: int) -> str:
    return "–" if value is None else f"{value:.{decimals}f}"


def _kappa(of: Kappa | None) -> str:
    if of is None or not of.count:
        return "–"
    return "both always say the same" if of.kappa is None else f"{of.kappa:.2f}"
