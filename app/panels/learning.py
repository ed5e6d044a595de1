"""Learning from corrections: a button that trains, what it brought, and whether its weights are used."""

from __future__ import annotations

from collections.abc import Callable

import anyio.to_thread

from fairyring.app.jobs.learnt import (
    FIGURES,
    Learnt,
    can_go_back,
    go_back,
    latest_learnt,
    use_learnt,
)
from fairyring.app.jobs.runner import Result
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import EMPTY, Markup, element
from fairyring.model.progress import Progress
from fairyring.storage.project import Project

STEPS = 200
STEPS_HINT = "Steps of the training. More learn more of these photos, and take longer."


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the button, the table and the choice."""
    gui, project = session.client.gui, workspace.project
    gui.add_html(element("h3", "Learn from corrections", class_="fr-heading").html)
    steps = gui.add_number("Steps", STEPS, min=1, max=20_000, step=1, hint=STEPS_HINT)
    train = gui.add_button("Learn from my corrections")
    shown = gui.add_html("")
    use = gui.add_button("Use these weights", visible=False)
    back = gui.add_button("Go back", visible=False)

    async def start() -> None:
        title = "Learning from corrections"
        workspace.start_job(session, title, learning_work(project, steps=int(steps.value)))

    async def use_latest() -> None:
        learnt = await anyio.to_thread.run_sync(latest_learnt, project)
        if learnt is not None:
            await anyio.to_thread.run_sync(use_learnt, project, learnt)
            session.notify(f"Predictions are made with {learnt.name} from now on.")
            workspace.refresh("predict", "learning")

    async def return_to_before() -> None:
        before = await anyio.to_thread.run_sync(go_back, project)
        session.notify(f"Predictions are made with {before.stem if before else 'nothing'} from now on.")
        workspace.refresh("predict", "learning")

    train.on_click(person_did(session, start))
    use.on_click(person_did(session, use_latest))
    back.on_click(person_did(session, return_to_before))

    async def redraw() -> None:
        learnt = await anyio.to_thread.run_sync(latest_learnt, project)
        used = await anyio.to_thread.run_sync(can_go_back, project)
        shown.content = learnt_table(learnt).html if learnt else EMPTY.html
        use.visible, back.visible = learnt is not None and not used, used
        train.disabled = project.read_only

    return redraw


def learning_work(project: Project, *, steps: int) -> Callable[[Progress], Result]:
    """The work of a job that trains on a project's corrections."""

    def work(progress: Progress) -> Result:
        # Torch takes seconds to load, and a project can be served without it.
        from fairyring.app.jobs.learning import learn

        learnt = learn(project, steps=steps, progress=progress)
        return Result(f"{learnt.name}: {learnt.photos} {what_it_brought(learnt)}")

    return work


def what_it_brought(learnt: Learnt) -> str:
    """The change of AP in a sentence."""
    if "AP" not in learnt.before or "AP" not in learnt.after:
        return "No complete photo was held back, so nobody can say whether it sees better."
    return (
        f"AP {100 * learnt.before['AP']:.1f} % before, {100 * learnt.after['AP']:.1f} % after, "
        f"on {learnt.held_out} photos that it did not learn from."
    )


def learnt_table(learnt: Learnt) -> Markup:
    """Figures before and after on the photos that were held out."""
    rows = [
        element(
            "tr",
            element("th", name, scope="row"),
            element("td", f"{100 * learnt.before[name]:.1f}", class_="fr-number"),
            element("td", f"{100 * learnt.after[name]:.1f}", class_="fr-number"),
            element("td", _change(learnt.after[name] - learnt.before[name]), class_="fr-number"),
        )
        for name in FIGURES
        if name in learnt.before and name in learnt.after
    ]
    words = (element("th", word, class_="fr-number") for word in ("before", "after", "change"))
    head = element("tr", element("th", "%"), *words)
    table = element("table", element("thead", head), element("tbody", *rows), class_="fr-list")
    return element(
        "div",
        element("strong", f"{learnt.name}, from {learnt.base}"),
        element("div", f"{learnt.photos} {what_it_brought(learnt)}", class_="fr-quiet"),
        table if rows else None,
        class_="fr-jobs",
    )


def _change(by: float) -> str:
    """With a sign and an arrow, so that colour is not needed."""
    arrow = "▲" if by > 0.0005 else "▼" if by < -0.0005 else "="
    return f"{arrow} {100 * by:+.1f}"
