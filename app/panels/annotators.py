"""Two annotators of the photo on screen: how far the annotations agree with a second version of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from sqlalchemy import Connection

from fairyring.app.editor_commands import COMMANDS
from fairyring.app.live.reviewing import compare_photo_with
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.review.two_annotators import agreement_on_image
from fairyring.model.evaluate.agreement import Agreement
from fairyring.model.evaluate.kappa import Kappa
from fairyring.storage.runs import images_seen_by, list_runs, require_run

NOBODY = "nobody else"
HOW = "Import what the second annotator labelled with --as predictions: it stands here then."


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the choice of the second version and the table of both."""
    gui = session.client.gui
    with gui.add_folder("Two annotators of this photo", expand_by_default=False):
        second = gui.add_dropdown(
            "Second annotator",
            [str(NOBODY)],
            hint=f"{COMMANDS['review'].keys[0]} draws this version beside the annotations",
        )
        shown = gui.add_html("")

    async def choose() -> None:
        chosen = second.value
        run = None if chosen == NOBODY else await workspace.read(lambda c: require_run(c, chosen))
        await compare_photo_with(workspace, session, run)
        session.redraw_at_once(("annotators", "beside"))

    async def redraw() -> None:
        image = session.image.id if session.image else None
        chosen = session.run_on_photo
        wanted = chosen.name if chosen and chosen.kind == "import" else None
        names, found = await workspace.read(partial(_find, image=image, second=wanted))
        if tuple(second.options) != (NOBODY, *names):
            second.options = (NOBODY, *names)
        second.value = wanted or NOBODY
        shown.content = agreement_table(found, wanted).html

    second.on_update(person_did(session, choose))
    return redraw


def _find(
    connection: Connection, *, image: int | None, second: str | None
) -> tuple[Sequence[str], Agreement | None]:
    """The imported versions, the latest first, and how far the chosen one agrees with the annotations."""
    versions = {row.run.name: row.run for row in reversed(list_runs(connection)) if row.run.kind == "import"}
    chosen = versions.get(second or "")
    if image is None or chosen is None or image not in {i.id for i in images_seen_by(connection, chosen.id)}:
        return list(versions), None
    return list(versions), agreement_on_image(connection, image, chosen)


def agreement_table(found: Agreement | None, second: str | None) -> Markup:
    """What both have, what one alone has, and how far their outlines, centres and flags agree."""
    if found is None:
        words = HOW if second is None else f"{second} holds nothing of this photo."
        return element("div", words, class_="fr-review fr-quiet")
    rows: Sequence[tuple[str, Content]] = (
        ("matched", found.matched),
        ("missed by the second", found.only_first),
        ("only the second has (extra)", found.only_second),
        ("IoU", "–" if found.iou is None else f"{found.iou.mean:.3f}"),
        ("between centres, px", "–" if found.px is None else f"{found.px.mean:.2f}"),
        ("kappa of doubtful", _kappa(found.doubtful)),
    )
    return element(
        "table",
        element(
            "thead",
            element("tr", element("th", "annotations and"), element("th", second, class_="fr-number")),
        ),
        element(
            "tbody",
            *(
                element("tr", element("td", name), element("td", value, class_="fr-number"))
                for name, value in rows
            ),
        ),
        class_="fr-list",
        aria_label="Two annotators",
    )


def _kappa(of: Kappa) -> str:
    if of.kappa is not None:
        return f"{of.kappa:.2f}"
    return "both always say the same" if of.count else "–"
