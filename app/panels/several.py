"""What the panel says of two and more selected caps: how many, their means, and what can be done to all."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.live.session import Selection
from fairyring.app.panels.facts import Facts, card
from fairyring.app.panels.markup import Markup, element
from fairyring.model.geometry.shapes import diameter_of_shape
from fairyring.storage.records import Annotation, Prediction

Cap = Annotation | Prediction


def selected_caps(caps: ImageCaps, selection: Selection) -> list[Cap]:
    """The caps of the image that are selected, as they are now; those that are gone are left out."""
    annotations = (caps.annotations.get(uid) for uid in selection.annotations)
    wanted = set(selection.predictions)
    return [
        *(each for each in annotations if each is not None and not each.deleted),
        *(each for each in caps.predictions if each.id in wanted),
    ]


def several_facts(selected: Sequence[Cap]) -> Markup:
    """The inspector's view of two and more caps."""
    annotations = [cap for cap in selected if isinstance(cap, Annotation)]
    predictions = [cap for cap in selected if isinstance(cap, Prediction)]
    widths = [diameter_of_shape(cap.whole) for cap in selected if cap.whole is not None]
    facts: Facts = [("Diameter", _spread(widths, "px", digits=1))]
    if predictions:
        facts.append(("Score", _spread([each.score for each in predictions], "", digits=2)))
    if annotations:
        facts += [
            ("Marked", _share(sum(each.cap.mark is not None for each in annotations), len(annotations))),
            ("Doubtful", _share(sum(each.cap.doubtful for each in annotations), len(annotations))),
            ("Ignored", _share(sum(each.cap.ignored for each in annotations), len(annotations))),
        ]
    kinds = ((len(annotations), "annotation"), (len(predictions), "prediction"))
    counted = [f"{count} {kind}{'' if count == 1 else 's'}" for count, kind in kinds if count]
    return card(
        element("strong", f"{len(selected)} selected"),
        element("span", " and ".join(counted), class_="fr-quiet"),
        facts=facts,
        commands=("accept" if predictions else "mark", "merge", "doubtful", "ignored", "delete"),
    )


def _spread(values: Sequence[float], unit: str, *, digits: int) -> str:
    if not values:
        return "not known"
    low, mean, high = (f"{value:.{digits}f}" for value in (min(values), fmean(values), max(values)))
    return f"mean {mean}{unit and ' '}{unit}, from {low} to {high}"


def _share(count: int, of: int) -> str:
    return "all" if count == of else f"{count} of {of}" if count else "none"
