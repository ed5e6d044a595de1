"""``fairyring evaluate``: predictions measured against the truth."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import typer
from msgspec import convert

from fairyring.app.commands.files import about
from fairyring.app.commands.progress import time_told
from fairyring.app.commands.rows import AsJson, console_of_tables
from fairyring.app.review.what_cdr_is import CDR
from fairyring.model.errors import FairyringError, FileError

if TYPE_CHECKING:
    from fairyring.model.evaluate.centre_figures import CapPairing, Evaluated

MEASURES = {"cdr": "CDR, %", "px": "pixels", "relative": "error / diameter"}

FOUND = ("S50", "S75", "S50_strict", "S50_small", "IoU85", "excursion")

commands = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Measure predictions against truth.")


class PairBy(StrEnum):
    """How predicted and true caps are paired."""

    iou = "iou"
    id = "id"


@commands.command()
def masks(
    predicted: Annotated[Path, typer.Argument(metavar="PRED.json[.gz]", help="Masks with scores.")],
    truth: Annotated[Path, typer.Argument(metavar="TRUTH.json[.gz]", help="COCO file with true masks.")],
    *,
    as_json: AsJson = False,
) -> None:
    """Compare masks: AP, precision, recall and the share of caps found, by light, form and size.

    Both may be COCO files or result lists; a mask without a score counts as sure. S50 is the share of caps
    of 30 px or more in diameter that a mask of score .5 or more matches at IoU .5 or more; strict leaves out
    caps that were found twice or taken for one with another.

    Example: `fairyring evaluate masks predictions.json truth.json --json`
    """
    from fairyring.model.coco.document import read_document
    from fairyring.model.evaluate.masks import figures_of_masks
    from fairyring.model.evaluate.pages import pages_of, truth_of

    with _naming(truth, predicted), time_told("Comparing masks"):
        # No text of a file is held longer than until its caps are read.
        read = truth_of(read_document(truth), masks=True, centres=False)
        figures = figures_of_masks(pages_of(read_document(predicted), read))
    _tell_of_images(figures, None)
    if as_json:
        typer.echo(json.dumps(figures))
    else:
        _print_masks(figures)


@commands.command(epilog=CDR)
def centres(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="PRED.json[.gz] [OTHER.json[.gz]] TRUTH.json[.gz]",
            help="Caps with centres, of one run or two, and caps with true centres.",
        ),
    ],
    *,
    by: Annotated[PairBy, typer.Option(help="Pair by mask or by id.")] = PairBy.iou,
    iou: Annotated[
        float | None, typer.Option(min=0.01, max=1, help="Least IoU of a pair; else 0.5.", show_default=False)
    ] = None,
    score: Annotated[
        float, typer.Option(min=0, max=1, help="Predictions of a lower score are left out.")
    ] = 0.0,
    as_json: AsJson = False,
) -> None:
    """Compare centres: the coordinate deviation rate of section 6.3 (CDR, %), pixels, error over diameter.

    Of two runs it also says how much further off the second one is than the first, on the caps that both have
    found. --json gives a row for every cap, and groups by size, visibility, light and form.

    Example: `fairyring evaluate centres centres.json truth.json --by id --json`
    """
    if not 2 <= len(files) <= 3:
        raise typer.BadParameter("Give predictions, perhaps those of another run, and last the truth.")
    if iou is not None and by is PairBy.id:
        raise typer.BadParameter("--iou says how far masks overlap; with --by id no mask is read.")
    from fairyring.model.evaluate.centre_figures import USUAL, CapPairing
    from fairyring.model.evaluate.two_runs import difference_of

    pairing = CapPairing(by=by.value, least_iou=iou or USUAL.least_iou, least_score=score)
    with time_told("Comparing centres"):
        runs = _evaluated_runs(files[:-1], files[-1], pairing)
    figures = [run.figures for run in runs]
    for each in figures:
        _warn_of_strange_ids(each, by)
    difference = difference_of(*runs) if len(runs) == 2 else None
    if as_json:
        typer.echo(msgspec.json.encode(figures[0] if difference is None else of_two(figures, difference)))
        return
    for file, each in zip(files, figures, strict=False):
        print_centres(str(file) if difference else "centres", each)
    if difference is not None:
        print_difference(difference)


def of_two(figures: Sequence[dict[str, Any]], difference: dict[str, Any]) -> dict[str, Any]:
    """The figures of two runs and of their difference, as they are printed as JSON."""
    return {"first": figures[0], "second": figures[1], "difference": difference}


def _evaluated_runs(predicted: list[Path], truth: Path, pairing: CapPairing) -> list[Evaluated]:
    """Every run against the truth, which is read once; errors name the file they are about."""
    from fairyring.model.coco.document import read_document
    from fairyring.model.evaluate.centre_figures import evaluated, truth_to_pair

    runs = []
    with _naming(truth, predicted[0]):
        # No text of a file is held longer than until its caps are read.
        read = truth_to_pair(read_document(truth), pairing)
    for path in predicted:
        with _naming(truth, path):
            runs.append(evaluated(read_document(path), read, pairing))
        _tell_of_images(runs[-1].figures, path if len(predicted) > 1 else None)
    return runs


@contextmanager
def _naming(truth: Path, predicted: Path) -> Iterator[None]:
    """Puts before errors the names of the files that they are about."""
    from fairyring.model.evaluate.pages import DocumentError

    try:
        yield
    except FileError:
        raise
    except FairyringError as error:
        side = error.side if isinstance(error, DocumentError) else None
        blamed = {"predicted": (predicted,), "truth": (truth,), None: (predicted, truth)}
        raise about(error, *blamed[side]) from error


def _tell_of_images(figures: dict[str, Any], predicted: Path | None) -> None:
    """Says which images of both sides were not compared."""
    from fairyring.model.evaluate.image_pairs import Pairing

    for sentence in convert(figures["pairing"], Pairing).sentences():
        typer.echo(sentence if predicted is None else f"{predicted}: {sentence}", err=True)


def _warn_of_strange_ids(figures: dict[str, Any], by: PairBy) -> None:
    if by is PairBy.id and not figures["matched"] and figures["missed"] and figures["extra"]:
        typer.echo(
            "No image has an id in both files: their ids are not of the same caps. --by iou pairs by mask.",
            err=True,
        )
    if figures["pairing"]["apart"] > figures["matched"] / 2:
        typer.echo(
            f"Of {figures['matched']} caps paired by id {figures['pairing']['apart']} lie further apart than "
            "half a cap: the ids of the two files are not of the same caps. --by iou pairs by mask.",
            err=True,
        )


def _print_masks(figures: dict[str, Any]) -> None:
    from rich.markup import escape
    from rich.table import Table

    console = console_of_tables()
    for names in (("AP", "AP50", "AP75", "AR", "P", "R"), FOUND):
        overall = Table(*names)
        overall.add_row(*(_shown(figures[name]) for name in names))
        console.print(overall)
    columns = ("count", "S50", "S75", "S50_strict", "AP", "IoU85", "excursion")
    groups = Table("by", "", *columns)
    for property_, values in figures["groups"].items():
        for value, group in values.items():
            groups.add_row(
                property_, escape(value), str(group["count"]), *(_shown(group[name]) for name in columns[1:])
            )
    console.print(groups)
    counts, best = figures["counts"], figures["best_f1"]
    console.print(
        f"Score ≥ {figures['score']}: {counts['matched']} matched, {counts['missed']} missed, "
        f"{counts['extra']} extra, {counts['dropped']} dropped in ignored regions "
        f"({counts['images']} images, {counts['predictions']} predictions of all scores)"
    )
    if best["score"] is not None:
        console.print(
            f"Best F1 {best['F1']:.4f} at score ≥ {best['score']:.3f}: P {best['P']:.4f}, R {best['R']:.4f}"
        )


def print_centres(title: str, figures: dict[str, Any]) -> None:
    """Prints the figures of one run as tables."""
    from rich.table import Table

    table = Table("", "mean", "95 %", "median", "p95", title=title)
    for key, name in MEASURES.items():
        spread = figures[key]
        mean, median, p95 = (_shown(spread[each]) for each in ("mean", "median", "p95"))
        table.add_row(name, mean, _bounds(figures["intervals"][key]), median, p95)
    console = console_of_tables()
    console.print(table)
    _print_groups(figures["groups"])
    bias = figures["bias_px"]
    shift = "" if bias is None else f", mean shift {bias[0]:+.3f}, {bias[1]:+.3f} px"
    console.print(
        f"{figures['matched']} matched, {figures['missed']} missed, {figures['extra']} extra{shift}"
    )


def _print_groups(groups: dict[str, dict[str, Any]]) -> None:
    from rich.markup import escape
    from rich.table import Table

    table = Table("by", "", "matched", "missed", "CDR, %", "95 %", "pixels")
    for kind, values in groups.items():
        for value, group in values.items():
            counts = (str(group[name]) for name in ("matched", "missed"))
            interval = _bounds(group["intervals"]["cdr"])
            means = _shown(group["cdr"]["mean"]), interval, _shown(group["px"]["mean"])
            table.add_row(kind, escape(value), *counts, *means)
    console_of_tables().print(table)


def print_difference(difference: dict[str, Any]) -> None:
    """Prints how much further off the second of two runs is."""
    from rich.table import Table

    table = Table("", "mean", "95 %", title="second minus first, caps that both found")
    for key, name in MEASURES.items():
        interval = difference[key]
        table.add_row(name, _shown(interval and interval["mean"]), _bounds(interval))
    console = console_of_tables()
    console.print(table)
    console.print(
        f"Of {difference['both']} caps the second is nearer in {difference['second_nearer']}, the first in "
        f"{difference['first_nearer']}; {difference['only_first']} were found by the first alone, "
        f"{difference['only_second']} by the second alone, {difference['neither']} by neither"
    )


def _bounds(interval: dict[str, Any] | None) -> str:
    return f"{interval['low']:.4f} to {interval['high']:.4f}" if interval else ""


def _shown(figure: float | None) -> str:
    return "" if figure is None else f"{figure:.4f}"
