"""The runs of predictions: listed, shown, renamed, compared with each other, exported."""

from __future__ import annotations

import json
from collections.abc import Sequence

from sqlalchemy import Connection

from fairyring.app.jobs.comparing_runs import compare_runs_work
from fairyring.app.jobs.exports import export_work
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.facts import definitions
from fairyring.app.panels.markup import Markup, element
from fairyring.storage.choices import Only
from fairyring.storage.exporting import Wanted
from fairyring.storage.records import Run
from fairyring.storage.runs import RunRow, list_runs, rename_run, require_run, require_two

NO_RUNS: Sequence[str] = ("none yet",)


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the folder of the runs, folded up."""
    gui = session.client.gui
    with gui.add_folder("Runs", expand_by_default=False):
        listed = gui.add_html("")
        chosen = gui.add_dropdown("Run", NO_RUNS)
        shown = gui.add_html("")
        name = gui.add_text("Another name", "")
        rename = gui.add_button("Rename this run")
        export = gui.add_button("Export this run as COCO (zip)")
        other = gui.add_dropdown("Compare with", NO_RUNS)
        compare = gui.add_button("Compare the two", hint="Their centres, with what people labelled")

    async def run_called(name: str) -> Run:
        return await workspace.read(lambda connection: require_run(connection, name))

    async def rename_it() -> None:
        run, new = await run_called(chosen.value), name.value.strip()
        await workspace.write(lambda connection: rename_run(connection, run.id, new))
        session.notify(f"{run.name} is called {new} now.")
        name.value = ""
        for tab in workspace.tabs:
            if tab.run is not None and tab.run.id == run.id:
                tab.run = await run_called(new)
            if tab.run_on_photo is not None and tab.run_on_photo.id == run.id:
                tab.run_on_photo = await run_called(new)
        workspace.refresh("runs", "status", "review", "gallery", "beside", "annotators", "plots")

    async def export_it() -> None:
        run = await run_called(chosen.value)
        work = export_work(
            workspace.project, Wanted(only=Only.predicted, run=run), run=workspace.crew.patient.run
        )
        workspace.start_job(session, f"Export: run {run.name}", work)

    async def compare_them() -> None:
        first, second = await run_called(chosen.value), await run_called(other.value)
        require_two(first, second)
        work = compare_runs_work(workspace.project, first, second)
        workspace.start_job(session, f"Comparison of {first.name} and {second.name}", work)

    async def show_chosen() -> None:
        session.refresh("runs")

    chosen.on_update(person_did(session, show_chosen))
    rename.on_click(person_did(session, rename_it))
    export.on_click(person_did(session, export_it))
    compare.on_click(person_did(session, compare_them))

    async def redraw() -> None:
        rows = await workspace.read(_newest_first)
        names: Sequence[str] = tuple(row.run.name for row in rows) or NO_RUNS
        for dropdown in (chosen, other):
            if tuple(dropdown.options) != names:
                dropdown.options = names
        listed.content = run_list(rows).html
        row = next((row for row in rows if row.run.name == chosen.value), None)
        shown.content = run_facts(row).html if row else ""
        export.disabled = not rows
        rename.disabled = not rows or workspace.project.read_only
        compare.disabled = len(rows) < 2

    return redraw


def _newest_first(connection: Connection) -> list[RunRow]:
    return list_runs(connection)[::-1]


def run_list(rows: Sequence[RunRow]) -> Markup:
    """Every run: how many images and caps, and of how many images its predictions are those shown."""
    if not rows:
        return element("div", "No predictions yet.", class_="fr-quiet")
    titles = ("Run", "Images", "Caps", "Shown")
    head = element("tr", *(element("th", title, class_=_numeric(title)) for title in titles))
    body = (
        element(
            "tr",
            element("td", element("span", row.run.name, class_="fr-ellipsis", title=row.run.name)),
            *(
                element("td", count, class_="fr-number")
                for count in (row.images, row.predictions, row.latest_of)
            ),
        )
        for row in rows
    )
    return element("table", element("thead", head), element("tbody", *body), class_="fr-list fr-runs")


def _numeric(title: str) -> str | None:
    return None if title == "Run" else "fr-number"


def run_facts(row: RunRow) -> Markup:
    """What made a run, when, and with which settings."""
    run = row.run
    return definitions(
        [
            ("Number", str(run.id)),
            ("Made", run.made_at[:16].replace("T", " ")),
            ("Kind", run.kind),
            ("Weights", run.weights[:12] if run.weights else "none"),
            *((name.replace("_", " "), _short(value)) for name, value in sorted(run.settings.items())),
        ],
        class_="fr-run",
    )


def _short(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value)
