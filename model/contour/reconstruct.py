"""Whole outlines and centres of an image's caps from what is visible of them (section 5)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from model.contour.circle import enclosing_circle
from model.contour.ellipse import grown, least_squares_ellipse
from model.contour.paper import LITERAL, PAPER, Reading, reconstruct_contour
from model.contour.silhouette import RIM_INSET, Silhouette, contours_of, silhouette_of_outline
from model.geometry import Circle, Ellipse, Outline, Points

Kind = Literal["regular", "irregular"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Reconstruction:
    """What is known of one cap's whole outline. Positions and lengths are continuous pixels."""

    whole: Circle | Ellipse | None = None
    centre: tuple[float, float] | None = None
    centre_sd: tuple[float, float] | None = None
    """One standard deviation along x and y; None for methods that do not know it."""
    shape: Kind = "regular"
    refusal: str | None = None
    """Why there is no outline, as a sentence; then whole and centre are None."""
    why: str = ""
    """How the outline came about, for a person: regular or how many corners, C*, the chosen shape, guards."""


def reconstruct(
    caps: Sequence[Outline],
    *,
    width: int,
    height: int,
    method: str | None = None,
    only: Sequence[int] | None = None,
) -> list[Reconstruction]:
    """The whole outlines of an image's caps, given the visible outlines of all of them.

    ``width`` and ``height`` are the image's. The caps that are not in ``only`` (indices; None: all) are
    context for the others; the answers come in the order of ``only``. ``method`` is one of `METHODS`, None
    the default; KeyError for any other. A cap that cannot be reconstructed is refused with a sentence, and
    its neighbours are not troubled by it.
    """
    silhouettes = [silhouette_of_outline(cap, width=width, height=height) for cap in caps]
    return reconstruct_silhouettes(silhouettes, method=method, only=only)


def reconstruct_silhouettes(
    caps: Sequence[Silhouette],
    *,
    method: str | None = None,
    only: Sequence[int] | None = None,
) -> list[Reconstruction]:
    """As `reconstruct`, from masks."""
    fit = METHODS[method or DEFAULT_METHOD]
    wanted = range(len(caps)) if only is None else only
    return [_fit_alone(caps[index], fit) for index in wanted]


def _fit_alone(cap: Silhouette, fit: Callable[[Points, float], Reconstruction]) -> Reconstruction:
    contours = contours_of(cap)
    if not contours:
        return Reconstruction(refusal="Nothing of this cap is visible inside the image.")
    return fit(contours[0], float(cap.mask.sum()))


def _by_reading(reading: Reading) -> Callable[[Points, float], Reconstruction]:
    def fit(contour: Points, area: float) -> Reconstruction:
        steps = reconstruct_contour(contour, area=area, reading=reading)
        return _found(grown(steps.whole, RIM_INSET), shape=steps.shape, why=steps.why)

    return fit


def _by_ellipse(contour: Points, _area: float) -> Reconstruction:
    whole = least_squares_ellipse(contour)
    if whole is None:
        return _found(enclosing_circle(contour), why="too few points for an ellipse; enclosing circle")
    return _found(grown(whole, RIM_INSET), why="ellipse on the whole contour")


def _by_enclosing_circle(contour: Points, _area: float) -> Reconstruction:
    # Not grown: the circle rests on the outermost pixels, whose centres all but reach the edge.
    return _found(enclosing_circle(contour), why="enclosing circle")


def _found(whole: Circle | Ellipse, *, shape: Kind = "regular", why: str) -> Reconstruction:
    return Reconstruction(whole=whole, centre=(whole.cx, whole.cy), shape=shape, why=why)


METHODS: dict[str, Callable[[Points, float], Reconstruction]] = {
    "paper": _by_reading(PAPER),
    "literal": _by_reading(LITERAL),
    "ellipse": _by_ellipse,
    "enclosing": _by_enclosing_circle,
}
DEFAULT_METHOD = "paper"
