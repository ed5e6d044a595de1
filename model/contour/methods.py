"""The methods by name: each takes the caps of an image and says what it makes of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import dist

from fairyring.model.contour.circle import enclosing_circle
from fairyring.model.contour.ellipse import grown, hull_ellipse, least_squares_ellipse
from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.method_names import MethodName
from fairyring.model.contour.paper import LITERAL, PAPER, Reading, reconstruct_contour
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.result import Reconstruction, ShapeKind
from fairyring.model.contour.silhouette import RIM_INSET, Silhouette, contours_of
from fairyring.model.geometry.shapes import Circle, Ellipse, Points, fit_of_shape


@dataclass(frozen=True, slots=True, kw_only=True)
class MaskedImage:
    """An image's caps, each with something to see."""

    caps: Sequence[Silhouette]
    width: int
    height: int
    priors: Priors = DEFAULT


Method = Callable[[MaskedImage], list[Reconstruction]]


def by_map(image: MaskedImage) -> list[Reconstruction]:
    """The robust, prior-aware, occlusion-aware ellipse."""
    fitted = fitted_image(image.caps, width=image.width, height=image.height, priors=image.priors)
    return fitted.reconstructions(image.caps)


def by_reading(reading: Reading) -> Method:
    """The paper's method in this reading."""

    def fit(contour: Points, area: float) -> Reconstruction:
        steps = reconstruct_contour(contour, area=area, reading=reading)
        return _found(grown(steps.whole, RIM_INSET), shape=steps.shape, why=steps.why)

    return _one_by_one(fit)


def _by_ellipse(contour: Points, _area: float) -> Reconstruction:
    return _near(contour, least_squares_ellipse(contour), of="the whole contour")


def _by_hull(contour: Points, _area: float) -> Reconstruction:
    return _near(contour, hull_ellipse(contour), of="the convex hull of the contour")


def _near(contour: Points, whole: Ellipse | None, *, of: str) -> Reconstruction:
    """The ellipse, or the enclosing circle where there is none whose centre lies in that."""
    around = enclosing_circle(contour)
    if whole is None:
        return _found(around, why="too few points for an ellipse; enclosing circle")
    if dist((whole.cx, whole.cy), (around.cx, around.cy)) > around.r:
        return _found(around, why="centre outside the enclosing circle; enclosing circle")
    return _found(grown(whole, RIM_INSET), why=f"ellipse on {of}")


def _by_enclosing_circle(contour: Points, _area: float) -> Reconstruction:
    # Not grown: the circle rests on the outermost pixels, whose centres all but reach the edge.
    return _found(enclosing_circle(contour), why="enclosing circle")


def _one_by_one(fit: Callable[[Points, float], Reconstruction]) -> Method:
    """A method that looks at the longest contour of one cap at a time."""

    def method(image: MaskedImage) -> list[Reconstruction]:
        return [fit(contours_of(cap, least=1)[0], float(cap.pixels)) for cap in image.caps]

    return method


def _found(whole: Circle | Ellipse, *, shape: ShapeKind = "regular", why: str) -> Reconstruction:
    return Reconstruction(fit=fit_of_shape(whole), shape=shape, why=why)


METHODS: dict[str, Method] = {
    MethodName.map: by_map,
    MethodName.paper: by_reading(PAPER),
    MethodName.literal: by_reading(LITERAL),
    MethodName.ellipse: _one_by_one(_by_ellipse),
    MethodName.hull: _one_by_one(_by_hull),
    MethodName.enclosing: _one_by_one(_by_enclosing_circle),
}
DEFAULT_METHOD = MethodName.map
