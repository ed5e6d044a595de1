"""``fairyring bench``: measurements anybody can run again, as ratios to a plain reference in the same run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from fairyring.app.commands import bench_network
from fairyring.app.commands.progress import time_told
from fairyring.app.commands.rows import AsJson, print_rows
from fairyring.model.contour.method_names import MethodName
from fairyring.model.errors import FairyringError

commands = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Measure, as ratios to a plain reference in the same run.",
)

commands.add_typer(bench_network.commands, name="network")


@commands.callback()
def measuring(context: typer.Context) -> None:
    """Says every few seconds that it is still measured."""
    context.with_resource(time_told("Measuring"))


BROWSER_MISSING = """This is measured in a browser, which playwright drives: pip install 'fairyring[bench]'"""

Quick = Annotated[bool, typer.Option(help="A small run, to see that it works.")]


@commands.command()
def store(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time list, open, edit and import in a project of 10 000 images and 500 000 instances.

    Example: `fairyring bench store --json`
    """
    with driving_a_browser():
        from fairyring.app.bench.store import store_rows

    print_rows("store", store_rows(quick=quick), as_json=as_json)


@commands.command("commands")
def whole_commands(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time import and export of 120 000 caps, from the command to the prompt, beside other readers.

    Example: `fairyring bench commands --json`
    """
    import tempfile

    from fairyring.app.bench.round_trip import round_trip_rows

    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as folder:
        rows = round_trip_rows(Path(folder), quick=quick)
    print_rows("commands", rows, as_json=as_json)


@commands.command()
def editor(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time the editor in headless Chromium: pointer to drawn, edit to saved, image to image.

    Example: `fairyring bench editor --json`
    """
    with driving_a_browser():
        from fairyring.app.bench.browser.editor import editor_rows

    print_rows("editor", editor_rows(quick=quick), as_json=as_json)


@commands.command()
def review(
    *,
    quick: Quick = False,
    seed: Annotated[int, typer.Option(help="Of the beds that are rendered.", min=0)] = 3005,
    as_json: AsJson = False,
) -> None:
    """Correct a bed of 60 caps and one of 214 in headless Chromium: inputs, a person's time, quality reached.

    Example: `fairyring bench review --json`
    """
    with driving_a_browser():
        from fairyring.app.bench.browser.review import review_rows

    print_rows("review", review_rows(quick=quick, seed=seed), as_json=as_json)


@commands.command()
def desk(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time the reviewer's desk with 1000 images of 60 caps, and have a script decide 50 of them by keys.

    Example: `fairyring bench desk --json`
    """
    with driving_a_browser():
        from fairyring.app.bench.browser.desk import desk_rows

    print_rows("desk", desk_rows(quick=quick), as_json=as_json)


@commands.command()
def page(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time the server's start, and count requests and bytes of a first and a second visit to the page.

    Example: `fairyring bench page --json`
    """
    with driving_a_browser():
        from fairyring.app.bench.browser.page import page_rows

    print_rows("page", page_rows(quick=quick), as_json=as_json)


@commands.command()
def fit(
    *,
    real: Annotated[
        Path | None, typer.Option(help="Folder of photos to predict by the shipped weights, measured too.")
    ] = None,
    quick: Quick = False,
    as_json: AsJson = False,
) -> None:
    """Time whole outlines by every way to ask for them, and check that all give the same.

    Example: `fairyring bench fit --real photos --json`
    """
    from fairyring.app.bench.fits import fit_rows

    print_rows("fit", fit_rows(quick=quick, real=real), as_json=as_json)


@commands.command()
def evaluation(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Measure memory and time of evaluating 120 000 caps against 120 000.

    Example: `fairyring bench evaluation --json`
    """
    from fairyring.app.bench.evaluation import evaluation_rows

    print_rows("evaluation", evaluation_rows(quick=quick), as_json=as_json)


@commands.command()
def people(*, quick: Quick = False, as_json: AsJson = False) -> None:
    """Time edits and live fits while twenty people drag caps on dense beds at once.

    Example: `fairyring bench people --json`
    """
    from fairyring.app.bench.people import people_rows

    print_rows("people", people_rows(quick=quick), as_json=as_json)


@commands.command()
def scene(
    *,
    real: Annotated[
        Path | None, typer.Option(help="Folder of real photos with checked.json, to compare with.")
    ] = None,
    sheet: Annotated[
        Path | None, typer.Option(help="PNG file for sixteen beds, and the real photos, on one sheet.")
    ] = None,
    quick: Quick = False,
    as_json: AsJson = False,
) -> None:
    """Time the renderer of beds, and measure its beds against real ones.

    Example: `fairyring bench scene --real photos --sheet sheet.png`
    """
    from fairyring.app.bench.scene import rim_rows, scene_rows
    from fairyring.app.bench.sheet import draw_sheet

    if sheet is not None:
        draw_sheet(sheet, real=real)
    print_rows("scene", scene_rows(quick=quick, real=real), as_json=as_json)
    if not as_json:
        title = "rims of caps on caps: 10 25 50 75 90 % quantiles, grey levels"
        print_rows(title, rim_rows(quick=quick, real=real), as_json=False)


@commands.command()
def contour(
    *,
    real: Annotated[
        Path | None, typer.Option(help="Folder of hand-checked photos with checked.json, measured too.")
    ] = None,
    pictures: Annotated[
        Path | None, typer.Option(help="Folder for pictures of the worst ten caps of the real photos.")
    ] = None,
    method: Annotated[
        list[MethodName] | None, typer.Option(help="Whose worst ten to draw; may be given again.")
    ] = None,
    quick: Quick = False,
    as_json: AsJson = False,
) -> None:
    """Measure every contour method's centres against the truth, and its time against OpenCV alone.

    Example: `fairyring bench contour --real beds --pictures worst --method map --json`
    """
    from fairyring.app.bench.contour import contour_rows
    from fairyring.app.bench.worst import draw_worst

    if pictures is not None and real is None:
        raise typer.BadParameter("--pictures are of real photos: give their folder with --real.")
    if pictures is not None and real is not None:
        draw_worst(real, pictures, methods=method or [MethodName.map])
    print_rows("contour", contour_rows(quick=quick, real=real), as_json=as_json)


@contextmanager
def driving_a_browser() -> Iterator[None]:
    """Wraps imports that need the extra ``bench``; FairyringError where that is not installed."""
    try:
        yield
    except ModuleNotFoundError as missing:
        if (missing.name or "").split(".")[0] != "playwright":
            raise
        raise FairyringError(BROWSER_MISSING) from None
