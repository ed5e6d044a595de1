"""A close-up of a cap as SVG: the photo, both outlines, and the line between their centres."""

from __future__ import annotations

from fairyring.app.addresses import photo_address
from fairyring.app.panels.markup import Markup, element
from fairyring.model.geometry.boxes import boxes_of_outlines
from fairyring.model.geometry.shapes import Outline, polygon_of_shape
from fairyring.storage.records import Annotation, Image, Prediction

AROUND = 1.5
"""Side of what it shows, in sides of the box around both outlines."""
WIDEST = 2000
"""Photos come as copies of this width where they are wider."""


def close_up(image: Image, said: Annotation | None, guessed: Prediction | None) -> Markup:
    """The cap of an annotation, a prediction or both; one of the two is there."""
    drawn = [] if said is None else _outline_of(said)
    predicted = [] if guessed is None else _outline_of(guessed)
    x0, y0, x1, y1 = boxes_of_outlines([[*drawn, *predicted]])[0].tolist()
    side = AROUND * max(x1 - x0, y1 - y0, 1.0)
    left, top = (x0 + x1 - side) / 2, (y0 + y1 - side) / 2
    width = f"?w={WIDEST}" if image.width > WIDEST else ""
    photo = element("image", href=photo_address(image) + width, width=image.width, height=image.height)
    centres = [each.centre for each in (said, guessed) if each is not None and each.centre is not None]
    lines = []
    if len(centres) == 2:
        (x, y), (u, v) = centres
        lines.append(element("line", x1=_at(x), y1=_at(y), x2=_at(u), y2=_at(v), class_="fr-error"))
    return element(
        "svg",
        photo,
        *(_polygon(part, "fr-drawn") for part in drawn),
        *(_polygon(part, "fr-predicted") for part in predicted),
        *lines,
        viewBox=f"{_at(left)} {_at(top)} {_at(side)} {_at(side)}",
        aria_hidden="true",
    )


def _outline_of(cap: Annotation | Prediction) -> Outline:
    """The whole outline, else what is visible."""
    visible = cap.cap.visible if isinstance(cap, Annotation) else cap.visible
    return [polygon_of_shape(cap.whole)] if cap.whole is not None else visible


def _polygon(part: list[float], class_: str) -> Markup:
    points = " ".join(f"{_at(x)},{_at(y)}" for x, y in zip(part[::2], part[1::2], strict=True))
    return element("polygon", points=points, class_=class_)


def _at(value: float) -> str:
    return f"{value:.1f}"
