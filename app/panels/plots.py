"""Plots of the review: CDR of each image and of each cap of the one on screen, and how centres shift.

viser draws them with uPlot. The element after each of them says which point of it is which cap, for
``static/editor/ui/plots.js``, which names the point under the pointer and opens what is clicked.
"""

from __future__ import annotations

from functools import partial
from urllib.parse import quote

import numpy as np
import viser
from sqlalchemy import Connection
from viser import uplot

from fairyring.app.addresses import review_address
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.plotted import Plot, further_out, plot_of_caps, plot_of_images, plot_of_shifts
from fairyring.storage.compared_caps import CapFigures, caps_of_image
from fairyring.storage.comparisons import ComparisonRow, list_comparisons
from fairyring.storage.predictions import latest_run
from fairyring.storage.review_figures import Shift, shifts

MOST_IMAGES, MOST_SHIFTS = 2000, 1000
NUMBERED = ("image", "cap")
WHOLE_STEPS = tuple(float(times * 10**power) for power in range(6) for times in (1, 2, 5))
BLUE, ORANGE, GREY = "#3d7ab8", "#c2410c", "#8a8f98"


def build(workspace: Workspace, session: Session) -> dict[str, Redraw]:
    """Builds the plots: of all images, and of the one on screen."""
    gui = session.client.gui
    with gui.add_folder("Plots"):
        of_images = _Drawn(
            gui, "CDR of each image, %", _cdr_series("Image", worst=True), axes=("image", "CDR, %")
        )
        of_caps = _Drawn(
            gui, "CDR of each cap of this image, %", _cdr_series("Cap", worst=False), axes=("cap", "%")
        )
        of_shifts = _Drawn(
            gui,
            "Predicted minus marked centre, px",
            _shift_series(),
            axes=("Δx, px", "Δy, px"),
        )

    async def redraw() -> None:
        only_sure = session.only_sure
        rows, found = await workspace.read(partial(_find, only_sure=only_sure))
        of_images.draw(plot_of_images(rows), "cdr", only_sure=only_sure)
        of_shifts.draw(plot_of_shifts(found), "shifts", only_sure=only_sure)

    async def redraw_caps() -> None:
        image, only_sure = session.image.id if session.image else None, session.only_sure
        caps = await workspace.read(partial(_find_caps, image=image))
        of_caps.draw(plot_of_caps(caps, only_sure=only_sure), "caps", only_sure=only_sure, image=image)

    return {"plots": redraw, "cap_plot": redraw_caps}


class _Drawn:
    """A plot in the panel with what is said below it."""

    def __init__(
        self,
        gui: viser.GuiApi,
        title: str,
        series: tuple[uplot.Series, ...],
        *,
        axes: tuple[str, str],
    ) -> None:
        nothing = tuple(np.zeros(2) for _ in series)
        self._title = title
        self._plot = gui.add_uplot(
            nothing,
            series,
            title=title,
            axes=(_x_axis(axes[0]), uplot.Axis(label=axes[1], size=44, labelSize=16)),
            cursor=uplot.Cursor(drag=uplot.Cursor_Drag(x=False, y=False)),
            aspect=1.5,
            visible=False,
        )
        self._below = gui.add_html("", visible=False)

    def draw(self, plot: Plot, name: str, *, only_sure: bool, image: int | None = None) -> None:
        """Shows a plot, which can be kept under this name; nothing where it has no points."""
        self._plot.visible = self._below.visible = bool(plot.points)
        if not plot.points:
            return
        self._plot.scales = {
            "x": uplot.Scale(time=False, auto=False, range=plot.x),
            "y": uplot.Scale(auto=False, range=plot.y),
        }
        self._plot.data = plot.columns
        self._below.content = below_plot(plot, self._title, name, only_sure=only_sure, image=image).html


def below_plot(plot: Plot, title: str, name: str, *, only_sure: bool, image: int | None = None) -> Markup:
    """What the pointer is at, and links to keep the plot."""
    where = partial(review_address, only_sure=only_sure, image=image)
    kinds = ("svg", "csv")
    links = [element("a", kind.upper(), href=where(f"{name}.{kind}"), download=True) for kind in kinds]
    points = ";".join(
        f"{each.x:.4g} {each.y:.4g} {each.image} {quote(each.annotation or '')} {quote(each.words)}"
        for each in plot.points
    )
    ends = " ".join(f"{end:.6g}" for end in (*plot.x, *plot.y))
    return element(
        "div",
        element("div", "A click opens what the pointer is at.", class_="fr-pointed"),
        element("div", further_out(plot.beyond)) if plot.beyond else None,
        *links,
        class_="fr-review fr-quiet fr-plot",
        role="group",
        aria_label=title,
        data_fairyring_plot=ends,
        data_fairyring_points=points,
    )


def _find(connection: Connection, *, only_sure: bool) -> tuple[list[ComparisonRow], list[Shift]]:
    run = latest_run(connection)
    if run is None:
        return [], []
    page = list_comparisons(
        connection, run.id, sort="name", descending=False, only_sure=only_sure, limit=MOST_IMAGES
    )
    measured = [row for row in page.rows if row.comparison.cdr_mean is not None]
    return measured, shifts(connection, run.id, only_sure=only_sure, most=MOST_SHIFTS)


def _find_caps(connection: Connection, *, image: int | None) -> list[CapFigures]:
    run = latest_run(connection)
    return [] if run is None or image is None else caps_of_image(connection, run.id, image)


def _cdr_series(what: str, *, worst: bool) -> tuple[uplot.Series, ...]:
    dots = uplot.Series_Points(show=True, size=5, fill=BLUE)
    found = [
        uplot.Series(label=what),
        uplot.Series(label="mean" if worst else "CDR", stroke=BLUE, width=1.5, points=dots),
        uplot.Series(label="floor", stroke=GREY, width=1.5, dash=(4, 3)),
    ]
    if worst:
        faint = uplot.Series_Points(show=True, size=4)
        found.append(uplot.Series(label="worst", stroke=ORANGE, width=0.5, points=faint))
    return tuple(found)


def _shift_series() -> tuple[uplot.Series, ...]:
    dots = uplot.Series_Points(show=True, size=4, stroke=BLUE, fill=BLUE)
    none = uplot.Series_Points(show=False)
    line = uplot.Series(label="95 of 100", stroke=ORANGE, width=1.5, spanGaps=True, points=none)
    return (
        uplot.Series(label="Δx"),
        uplot.Series(label="Δy", stroke=BLUE, width=0, points=dots),
        line,
        line,
    )


def _x_axis(label: str) -> uplot.Axis:
    """Images and caps are numbered, so between two of them stands nothing."""
    if label not in NUMBERED:
        return uplot.Axis(label=label, size=34, labelSize=16)
    return uplot.Axis(label=label, size=34, labelSize=16, incrs=WHOLE_STEPS)
