"""The inspector: everything known about the selected cap, or a summary of the image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sqlalchemy import Connection

from fairyring.app.caps.comparison import near_cap
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.records import truth_record
from fairyring.app.caps.repeated import marks_on
from fairyring.app.caps.tasks import judged
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.arcs import arcs_list
from fairyring.app.panels.buttons import worded_button
from fairyring.app.panels.callbacks import Redraw
from fairyring.app.panels.facts import Facts, card
from fairyring.app.panels.first_steps import first_steps, offer_prediction
from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.panels.several import selected_caps, several_facts
from fairyring.app.panels.status import run_badge
from fairyring.app.panels.tags import tags_of
from fairyring.app.panels.verdicts import open_demand
from fairyring.app.protocol import Arc
from fairyring.model.evaluate.centres import Pair
from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.contents import load_prediction, load_predictions, load_run
from fairyring.storage.journal import Entry, history
from fairyring.storage.records import Annotation, Mark, Prediction, Run, Shape
from fairyring.storage.runs import predictions_by
from fairyring.storage.verdicts import verdicts_of


@dataclass(frozen=True)
class Background:
    """What the inspector shows of an annotation beside the annotation itself."""

    entries: Sequence[Entry]
    prediction: Prediction | None
    run: Run | None
    note: str = ""
    """How the whole outline came about."""
    arcs: Sequence[Arc] = ()
    """The pieces of the visible outline."""
    pair: Pair | None = None
    floor: float | None = None
    """CDR, percent, that the mark has by itself; None where that is not known."""


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the inspector."""
    shown = session.client.gui.add_html("")

    async def redraw() -> None:
        shown.content = (await _inspect(workspace, session)).html

    return redraw


async def _inspect(workspace: Workspace, session: Session) -> Markup:
    caps = session.caps
    if caps is None:
        return first_steps(workspace.project)
    match selected_caps(caps, session.selection):
        case []:
            found = await workspace.read(lambda connection: _shown_besides(connection, caps, session))
            if found is not None:
                return prediction_facts(*found)
            said = await workspace.read(lambda connection: verdicts_of(connection, caps.image.id))
            return summary(caps, open_demand(said))
        case [Annotation() as annotation]:
            background = await _background(workspace, session, caps, annotation)
            return annotation_facts(annotation, background, second=session.second_annotator)
        case [Prediction() as prediction]:
            return prediction_facts(prediction, session.run)
        case several:
            return several_facts(several)


def _shown_besides(
    connection: Connection, caps: ImageCaps, session: Session
) -> tuple[Prediction, Run | None] | None:
    """A selected prediction that is not offered: turned down, or of another run than the one on screen."""
    if len(session.selection.predictions) != 1 or session.selection.annotations:
        return None
    found = load_prediction(connection, session.selection.predictions[0])
    if found is None or found.image != caps.image.id:
        return None
    return found, load_run(connection, found.run)


async def _background(
    workspace: Workspace, session: Session, caps: ImageCaps, annotation: Annotation
) -> Background:
    started_from = annotation.cap.prediction

    def gather(connection: Connection) -> Background:
        prediction = load_prediction(connection, started_from) if started_from is not None else None
        marks = marks_on(connection, caps.image.id)
        return Background(
            floor=marks.floor_of(annotation, truth_record(annotation, caps.image), caps.image),
            entries=history(connection, annotation.uid),
            prediction=prediction,
            run=load_run(connection, prediction.run) if prediction else None,
        )

    # A cap is compared with all that was said, also with what is not offered where the cap lies.
    run, image = session.run_on_photo, caps.image.id
    said = await workspace.read(
        lambda connection: (
            predictions_by(connection, run.id, image) if run else load_predictions(connection, image)
        )
    )
    worker = workspace.crew.of_image(caps.image.id)
    near = near_cap(annotation, said)
    note, arcs, pair = await session.copy.ask(worker, caps, judged, annotation.uid, near)
    return replace(await workspace.read(gather), note=note, arcs=arcs, pair=pair)


def annotation_facts(annotation: Annotation, background: Background, *, second: str | None = None) -> Markup:
    """The inspector's view of an annotation, beside a second annotator's version, else a model's."""
    cap = annotation.cap
    flags = [
        element("span", word, class_="fr-badge fr-warn")
        for word, raised in (("ignored", cap.ignored), ("doubtful", cap.doubtful))
        if raised
    ]
    facts: Facts = [
        ("Centre", _point(annotation.centre)),
        ("Whole", _shape(annotation.whole)),
        ("Fit", background.note),
        *([("Rim", arcs_list(background.arcs))] if background.arcs else []),
        ("Mark", _mark(cap.mark)),
        *error_facts(background.pair, floor=background.floor, second=second),
        *([] if cap.order is None else [("Overlap", f"{cap.order} (higher lies in front)")]),
        ("From", _origin(background)),
        ("Edited", _last_edit(annotation, background.entries)),
    ]
    title = element("strong", f"Cap {annotation.uid[:8]}", title=annotation.uid)
    marking = "mark" if cap.mark is None else "unmark"
    return card(title, *flags, facts=facts, commands=(marking, "doubtful", "ignored", "delete"))


def error_facts(pair: Pair | None, *, floor: float | None, second: str | None = None) -> Facts:
    """How far a prediction lies from a mark, beside the CDR in percent that the mark has by itself.

    ``second``: what the second annotator's version is called that stands for predictions, None for a model's.
    """
    if pair is None:
        return [
            ("Second", f"{second} has no such cap") if second else ("Prediction", "none matches this cap")
        ]
    if pair.error is None:
        measured = f"how far {second} lies from it" if second else "its prediction"
        return [("CDR", f"mark the cap to measure {measured}")]
    error = pair.error
    signed = f"Δx {error.dx:+.2f}, Δy {error.dy:+.2f} px"
    share = "" if error.relative is None else f", {100 * error.relative:.2f} % of the diameter"
    own = "the mark's own is not known" if floor is None else f"the mark's own is {floor:.3f} %"
    return [
        ("CDR", element("span", f"{error.cdr:.3f} %", class_="fr-figure", title=signed)),
        ("Floor", own),
        ("Error", f"{error.px:.2f} px{share}"),
    ]


def prediction_facts(prediction: Prediction, run: Run | None) -> Markup:
    """The inspector's view of a prediction, or of a cap that a second annotator labelled."""
    second = run.second_annotator if run else None
    facts: Facts = [
        ("Centre", _point(prediction.centre)),
        ("Whole", _shape(prediction.whole)),
        *([] if second else [("Score", f"{prediction.score:.3f}")]),
        *_quality(prediction),
        ("From" if second else "Run", run_badge(run) if run else "unknown"),
    ]
    title = f"Second annotator’s cap {prediction.id}" if second else f"Prediction {prediction.id}"
    commands = ("take_models", "take_annotators") if second else ("accept", "delete")
    return card(element("strong", title), facts=facts, commands=commands, second=second)


def _quality(prediction: Prediction) -> Facts:
    if prediction.quality is None:
        return []
    figure = element(
        "span",
        f"{prediction.quality:.2f} IoU expected",
        title="How well its outline is likely to match what is visible of the cap",
    )
    return [("Quality", figure)]


def summary(caps: ImageCaps, demand: str | None = None) -> Markup:
    """Counts of the image on screen and its tags, and what a reviewer demands, while nothing is selected."""
    is_empty = not caps.predictions and all(a.deleted for a in caps.annotations.values())
    facts: Facts = [("Caps", _count("caps")), ("Ignored", _count("ignored")), ("Predictions", _count("open"))]
    if demand is not None:
        facts.insert(0, ("Review", element("strong", demand)))
    title = (element("strong", "The image"), worded_button("tour", class_="fr-tour fr-push"))
    below = (tags_of(caps.image), offer_prediction(caps.image) if is_empty else None)
    return card(*title, facts=facts, below=element("div", *below))


def _count(what: str) -> Markup:
    """The editor writes it: it knows of what was done before that is stored."""
    return element("span", data_fairyring_count=what)


def _point(point: tuple[float, float] | None) -> str:
    return "not known" if point is None else f"{point[0]:.2f}, {point[1]:.2f} px"


def _shape(shape: Shape | None) -> str:
    if shape is None:
        return "not known"
    if isinstance(shape, Circle):
        return f"circle ⌀ {2 * shape.r:.1f} px"
    return f"ellipse {2 * shape.a:.1f} × {2 * shape.b:.1f} px at {shape.theta_deg:.0f}°"


def _mark(mark: Mark | None) -> str:
    if mark is None:
        return "none: the fit gives the centre"
    if isinstance(mark, Circle):
        return f"circle ⌀ {2 * mark.r:.1f} px"
    return f"polygon of {len(mark.points) // 2} points" if isinstance(mark, Polygon) else "ellipse"


def _origin(background: Background) -> Content:
    prediction = background.prediction
    if prediction is None:
        return (
            "imported" if background.entries and background.entries[0].user == "import" else "drawn by hand"
        )
    badge = run_badge(background.run) if background.run else "a prediction"
    if background.run and background.run.second_annotator:
        return badge
    return element("span", badge, f" score {prediction.score:.2f}")


def _last_edit(annotation: Annotation, entries: Sequence[Entry]) -> str:
    if not entries:
        return f"revision {annotation.revision}"
    last = entries[-1]
    return f"{last.user}, {last.made_at[:16].replace('T', ' ')} UTC, revision {last.revision}"
