"""``fairyring evaluate``: predictions measured against the truth."""

from __future__ import annotations

import json
from collections.abc import Callable
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from msgspec import convert

from fairyring.app.commands.files import about
from fairyring.app.commands.rows import AsJson, console_of_tables
from fairyring.model.errors import FairyringError

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
    from fairyring.model.evaluate.masks import evaluate_masks

    figures = _evaluated(evaluate_masks, predicted, truth)
    if as_json:
        typer.echo(json.dumps(figures))
    else:
        _print_masks(figures)


@commands.command()
def centres(
    predicted: Annotated[Path, typer.Argument(metavar="PRED.json[.gz]", help="Caps with centres.")],
    truth: Annotated[Path, typer.Argument(metavar="TRUTH.json[.gz]", help="Caps with true centres.")],
    *,
    by: Annotated[PairBy, typer.Option(help="Pair by mask (IoU 0.5 or more) or by id.")] = PairBy.iou,
    as_json: AsJson = False,
) -> None:
    """Compare centres: the coordinate deviation rate of section 6.3 (CDR, %), pixels, error over diameter.

    Example: `fairyring evaluate centres centres.json truth.json --by id --json`
    """
    from fairyring.model.evaluate.centres import evaluate_centres

    figures = _evaluated(partial(evaluate_centres, by=by.value), predicted, truth)
    if figures["pairing"]["apart"] > figures["matched"] / 2:
        typer.echo(
            f"Of {figures['matched']} caps paired by id {figures['pairing']['apart']} lie further apart than "
            "half a cap: the ids of the two files are not of the same caps. --by iou pairs by mask.",
            err=True,
        )
    if as_json:
        typer.echo(json.dumps(figures))
    else:
        _print_centres(figures)


def _evaluated(
    evaluate: Callable[[Any, Any], dict[str, Any]], predicted: Path, truth: Path
) -> dict[str, Any]:
    """The figures of two files; errors name the file they are about."""
    from fairyring.model.coco.document import read_document
    from fairyring.model.evaluate.image_pairs import Pairing
    from fairyring.model.evaluate.pages import DocumentError

    documents = read_document(predicted), read_document(truth)
    blamed = {"predicted": (predicted,), "truth": (truth,), None: (predicted, truth)}
    try:
        figures = evaluate(*documents)
    except FairyringError as error:
        side = error.side if isinstance(error, DocumentError) else None
        raise about(error, *blamed[side]) from error
    for sentence in convert(figures["pairing"], Pairing).sentences():
        typer.echo(sentence, err=True)
    return figures


def _print_masks(figures: dict[str, Any]) -> None:
    from rich.markup import escape
    from rich.table import Table

    console = console_of_tables()
    for names in (("AP", "AP50", "AP75", "AR", "P", "R"), ("S50", "S75", "S50_strict", "S50_small")):
        overall = Table(*names)
        overall.add_row(*(_shown(figures[name]) for name in names))
        console.print(overall)
    columns = ("count", "S50", "S75", "S50_strict", "AP")
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


def _print_centres(figures: dict[str, Any]) -> None:
    from rich.table import Table

    table = Table("", "mean", "median", "p95", title="centres")
    for key, title in (("cdr", "CDR, %"), ("px", "pixels"), ("relative", "error / diameter")):
        spread = figures[key]
        table.add_row(title, *(_shown(spread[name]) for name in ("mean", "median", "p95")))
    console = console_of_tables()
    console.print(table)
    bias = figures["bias_px"]
    shift = "" if bias is None else f", mean shift {bias[0]:+.3f}, {bias[1]:+.3f} px"
    console.print(
        f"{figures['matched']} matched, {figures['missed']} missed, {figures['extra']} extra{shift}"
    )


def _shown(figure: float | None) -> str:
    return "" if figure is None else f"{figure:.4f}"
