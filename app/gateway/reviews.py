"""The review as a page to print, and its plots and tables to keep."""

from __future__ import annotations

import csv
import io
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import anyio.to_thread
from sqlalchemy import Connection
from starlette.requests import Request
from starlette.responses import HTMLResponse, PlainTextResponse, Response

from fairyring.app.gateway.login import name_of
from fairyring.app.report.bars import Bar, rows_of_bars
from fairyring.app.report.drawing import Drawing, file_of
from fairyring.app.report.page import page_of
from fairyring.app.report.plots import drawing_of_shifts
from fairyring.app.review.figures import review_of
from fairyring.app.static_folder import STATIC
from fairyring.storage.compared_caps import caps_of_image
from fairyring.storage.comparisons import list_comparisons
from fairyring.storage.errors import StoreError
from fairyring.storage.images import get_image
from fairyring.storage.predictions import latest_run
from fairyring.storage.project import Project
from fairyring.storage.records import Run
from fairyring.storage.review_figures import shifts as find_shifts
from fairyring.storage.runs import get_run

REPORT = "report.html"
OWN_LOOKS = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'"
"""Content policy of the report, which holds its looks and pictures itself and loads nothing."""
EVERYTHING = 1_000_000
Rows = tuple[Sequence[str], Sequence[Sequence[Any]]]


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """What is to be kept: of all images or of one, of which run, with or without unsure marks."""

    what: str
    image: int | None
    run: int | None
    only_sure: bool


def reviews_of(project: Project) -> Callable[[Request], Awaitable[Response]]:
    """The endpoint of `REVIEWS`: ``report.html``; ``cdr``, ``caps`` and ``shifts`` as ``svg`` and ``csv``."""

    async def reviews(request: Request) -> Response:
        if name_of(request) is None:
            return PlainTextResponse("Open the page first and say your name.", status_code=401)
        asked = _Asked(
            what=request.path_params["what"],
            image=_number(request, "image"),
            run=_number(request, "run"),
            only_sure=request.query_params.get("sure") == "1",
        )
        answer = await anyio.to_thread.run_sync(partial(_answer, project, asked))
        return answer or PlainTextResponse("There is no such review.", status_code=404)

    return reviews


NOTHING = 0
"""A number that no image and no run has."""


def _number(request: Request, name: str) -> int | None:
    """The number that was said; None where none was, `NOTHING` where it is none."""
    said = request.query_params.get(name, "")
    return None if not said else int(said) if said.isdecimal() and len(said) < 19 else NOTHING


def _answer(project: Project, asked: _Asked) -> Response | None:
    if asked.image is not None and not _has_image(project, asked.image):
        return None
    if asked.what == REPORT:
        return _report(project, asked)
    name, _, kind = asked.what.partition(".")
    if name not in PLOTS or kind not in ("svg", "csv"):
        return None
    with project.read() as connection:
        run = _run(connection, asked)
        if run is None:
            return None
        plot, rows = PLOTS[name](connection, run.id, asked)
    if kind == "csv":
        return _kept(_csv(rows), "text/csv; charset=utf-8", asked.what)
    looks = (STATIC / "report.css").read_text(encoding="utf-8")
    return _kept(file_of(plot, looks), "image/svg+xml", asked.what)


def _has_image(project: Project, number: int) -> bool:
    with project.read() as connection, suppress(StoreError):
        get_image(connection, number)
        return True
    return False


def _report(project: Project, asked: _Asked) -> Response | None:
    with project.read() as connection:
        run = None if asked.run is None else _run(connection, asked)
    if run is None and asked.run is not None:
        return None
    among = None if asked.image is None else {asked.image}
    page = page_of(project, review_of(project, run=run, among=among, only_sure=asked.only_sure))
    return HTMLResponse(page, headers={"Content-Security-Policy": OWN_LOOKS})


def _run(connection: Connection, asked: _Asked) -> Run | None:
    """The run that was asked for, else the latest; None where there is none."""
    if asked.run is None:
        return latest_run(connection)
    with suppress(StoreError):
        return get_run(connection, asked.run)
    return None


def _of_images(connection: Connection, run_id: int, asked: _Asked) -> tuple[list[Drawing], Rows]:
    found = list_comparisons(
        connection, run_id, sort="name", descending=False, only_sure=asked.only_sure, limit=EVERYTHING
    )
    figures = [(row.file_name, row.comparison) for row in found.rows]
    bars = [
        Bar(name=name, cdr=each.cdr_mean, floor=each.floor_mean)
        for name, each in figures
        if each.cdr_mean is not None
    ]
    bars.sort(key=lambda bar: bar.cdr, reverse=True)
    columns = ("cdr_mean", "floor_mean", "cdr_worst", "dx", "dy", "measured", "matched", "missed", "extra")
    rows = [(name, *(getattr(each, column) for column in columns)) for name, each in figures]
    return rows_of_bars(bars, what="Mean CDR by image"), (("image", *columns), rows)


def _of_caps(connection: Connection, run_id: int, asked: _Asked) -> tuple[list[Drawing], Rows]:
    caps = [] if asked.image is None else caps_of_image(connection, run_id, asked.image)
    numbered = [(nth, each) for nth, each in enumerate(caps, start=1) if each.cdr is not None]
    measured = [(n, each) for n, each in numbered if not (asked.only_sure and (each.unsure or each.doubtful))]
    bars = [Bar(name=f"cap {nth}", cdr=each.cdr or 0.0, floor=each.floor) for nth, each in measured]
    columns = ("annotation", "cdr", "floor", "dx", "dy", "iou", "annotator", "size", "shape", "visibility")
    rows = [[nth, *(getattr(each, column) for column in columns)] for nth, each in measured]
    return rows_of_bars(bars, what="CDR of each cap"), (("cap", *columns), rows)


def _of_shifts(connection: Connection, run_id: int, asked: _Asked) -> tuple[list[Drawing], Rows]:
    found = find_shifts(connection, run_id, only_sure=asked.only_sure, most=EVERYTHING)
    rows = [(each.image, each.annotation, each.dx, each.dy) for each in found]
    plot = drawing_of_shifts([(each.dx, each.dy) for each in found])
    return plot, (("image", "cap", "dx", "dy"), rows)


PLOTS: dict[str, Callable[[Connection, int, _Asked], tuple[list[Drawing], Rows]]] = {
    "cdr": _of_images,
    "caps": _of_caps,
    "shifts": _of_shifts,
}


def _csv(rows: Rows) -> str:
    written = io.StringIO()
    writer = csv.writer(written)
    writer.writerow(rows[0])
    writer.writerows(rows[1])
    return written.getvalue()


def _kept(text: str, media_type: str, name: str) -> Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"', "Cache-Control": "no-store"}
    return Response(text, media_type=media_type, headers=headers)
