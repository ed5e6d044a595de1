"""Two runs, so two weights, side by side: figures of both, and the caps that changed most."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
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
from fairyring.app.panels.markup import Markup, element
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_runs import (
    BothRuns,
    ChangedCap,
    both_runs,
    changed_caps,
    lacking_comparison,
)
from fairyring.storage.predictions import latest_run
from fairyring.storage.records import Run
from fairyring.storage.review_figures import Totals
from fairyring.storage.runs import all_runs, require_run

NOTHING = "nothing"
LATEST = "the latest"
ON_SCREEN = "the latest of each image"


@dataclass(frozen=True, kw_only=True)
class Beside:
    """What stands side by side."""

    runs: list[str]
    """Names of all runs, the latest first."""
    before: Run | None = None
    after: Run | None = None
    lacking: Sequence[Run] = ()
    """Those of the two that images are not compared with as they are now."""
    both: BothRuns | None = None
    changed: list[ChangedCap] = field(default_factory=list)


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the choice of the other run and what stands below it."""
    gui = session.client.gui
    with gui.add_folder("Two runs side by side", expand_by_default=False):
        first = gui.add_dropdown("First run", [str(NOTHING)])
        second = gui.add_dropdown("Second run", [str(LATEST)])
        drawn = gui.add_dropdown(
            "On the photo",
            [str(ON_SCREEN)],
            hint=f"Whose outlines and centres {COMMANDS['review'].keys[0]} draws beside the annotations",
        )
        shown = gui.add_html("")
        compare = gui.add_button("Compare images with these runs", visible=False)

    async def find() -> Beside:
        names = [None if box.value in (NOTHING, LATEST) else box.value for box in (first, second)]
        return await workspace.read(partial(find_beside, chosen=names[0], against=names[1]))

    async def choose() -> None:
        session.redraw_at_once(("beside",))

    async def draw() -> None:
        chosen = drawn.value
        run = None if chosen == ON_SCREEN else await workspace.read(lambda c: require_run(c, chosen))
        await compare_photo_with(workspace, session, run)
        session.redraw_at_once(("annotators",))

    async def start() -> None:
        for run in (await find()).lacking:
            work = compare_with_run_work(workspace.project, run)
            workspace.start_job(session, f"Comparison with {run.name}", work)

    async def redraw() -> None:
        found = await find()
        for box, unsaid in ((first, NOTHING), (second, LATEST), (drawn, ON_SCREEN)):
            options = (unsaid, *found.runs)
            if tuple(box.options) != options:
                box.options = options
        drawn.value = session.run_on_photo.name if session.run_on_photo else ON_SCREEN
        shown.content = beside_page(found).html
        compare.visible = len(found.lacking) > 0

    for box in (first, second):
        box.on_update(person_did(session, choose))
    drawn.on_update(person_did(session, draw))
    compare.on_click(person_did(session, start))
    return redraw


def find_beside(connection: Connection, *, chosen: str | None, against: str | None = None) -> Beside:
    """The figures of the runs of these names (None: the latest one), on the images that both saw."""
    runs = {run.name: run for run in reversed(all_runs(connection))}
    before = runs.get(chosen or "")
    after = latest_run(connection) if against is None else runs.get(against)
    if before is None or after is None or before.id == after.id:
        return Beside(runs=list(runs))
    return Beside(
        runs=list(runs),
        before=before,
        after=after,
        lacking=[run for run in (before, after) if lacking_comparison(connection, run.id)],
        both=both_runs(connection, before.id, after.id),
        changed=changed_caps(connection, before.id, after.id),
    )


def beside_page(found: Beside) -> Markup:
    """Two columns of figures, and the caps that changed most, each leading to its cap."""
    if found.both is None or found.before is None or found.after is None:
        words = "Choose two different runs." if len(found.runs) > 1 else "There is one run alone."
        return element("div", words, class_="fr-review fr-quiet")
    if not found.both.images:
        return element("div", "No image was compared with both yet.", class_="fr-review fr-quiet")
    head = element(
        "tr",
        element("th", how_many(found.both.images, "image")),
        *(element("th", run.name, class_="fr-number") for run in (found.before, found.after)),
    )
    return element(
        "div",
        element(
            "table",
            element("thead", head),
            element("tbody", *_rows(found.both, found.before, found.after)),
            class_="fr-list",
            aria_label="Two runs side by side",
        ),
        _changed(found.changed, found.after),
        class_="fr-review",
    )


def _rows(both: BothRuns, before: Run, after: Run) -> list[Markup]:
    """A figure of both runs a row; each leads to the caps that it counts, on the images that both saw."""
    sides = [(both.first, before, after), (both.second, after, before)]
    columns = [_numbers(of, Group(by="run", value=str(run.id), beside=other.id)) for of, run, other in sides]
    return [
        element(
            "tr", element("td", name), *(element("td", each[name], class_="fr-number") for each in columns)
        )
        for name in columns[0]
    ]


def _numbers(of: Totals, group: Group) -> dict[str, Markup]:
    """By what they are called."""
    return {
        "CDR %": counted("worst", _number(of.cdr), group=group),
        "floor %": counted("worst", _number(of.floor), group=group),
        "Δx, px": counted("worst", _number(of.dx), group=group),
        "Δy, px": counted("worst", _number(of.dy), group=group),
        "measured": counted("worst", of.measured, group=group),
        "matched": counted("matched", of.matched, group=group),
        "missed": counted("missed", of.missed, group=group),
        "extra": counted("extra", of.extra, group=group),
    }


def _changed(caps: Sequence[ChangedCap], after: Run) -> Markup | None:
    if not caps:
        return None
    rows = (
        element(
            "tr",
            element("td", element("span", cap.file_name, class_="fr-ellipsis", title=cap.annotation)),
            *(
                element("td", _number(value), class_="fr-number")
                for value in (cap.before, cap.after, cap.floor)
            ),
            tabindex=0,
            role="button",
            data_fairyring_open=cap.image,
            data_fairyring_select=cap.annotation,
            data_fairyring_run=after.id,
            data_fairyring_differences=True,
        )
        for cap in caps
    )
    return element(
        "table",
        titles_of({"Changed most": None, "before": 50, "after": 50, "floor": 50}),
        element("tbody", *rows),
        class_="fr-list",
        aria_label="Caps that changed most",
    )


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
