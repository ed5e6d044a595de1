"""Commands on masks: whole outlines and centres, their priors, and how good centres are."""

from __future__ import annotations

import gzip
import json
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from app.commands.progress import shown_on_stderr
from model.errors import FairyringError

AsJson = Annotated[bool, typer.Option("--json", help="Print the figures as JSON.")]
Labels = Annotated[Path, typer.Argument(metavar="COCO.json[.gz]", help="COCO file with checked outlines.")]


class FileError(FairyringError):
    """A file that cannot be read or written."""


class MethodName(StrEnum):
    """Ways to reconstruct a cap."""

    map = "map"
    paper = "paper"
    literal = "literal"
    ellipse = "ellipse"
    enclosing = "enclosing"


class PairBy(StrEnum):
    """How predicted and true caps are paired."""

    iou = "iou"
    id = "id"


def contour(
    masks: Annotated[Path, typer.Argument(metavar="MASKS.json[.gz]", help="COCO file: RLE or polygons.")],
    *,
    out: Annotated[Path, typer.Option(help="Where to write the same with centres; .gz compresses.")],
    method: Annotated[MethodName, typer.Option(help="How to reconstruct.")] = MethodName.map,
    priors: Annotated[Path | None, typer.Option(help="File made by fairyring priors.")] = None,
) -> None:
    """Find whole outlines and centres from visible masks.

    Example: `fairyring contour masks.json --out centres.json --method map`
    """
    from model.contour.coco import contour_document
    from model.contour.priors import DEFAULT, read_priors

    document = read_json(masks)
    chosen = read_priors(priors) if priors else DEFAULT
    with shown_on_stderr() as progress, _named(masks):
        found = contour_document(document, method=method.value, priors=chosen, progress=progress)
    refused = sum(annotation["center"] is None for annotation in found["annotations"])
    write_json(found, out)
    typer.echo(f"{len(found['annotations'])} caps in {out}, {refused} of them refused", err=True)


def priors(
    labels: Labels,
    *,
    out: Annotated[Path, typer.Option(help="Where to write the priors, as JSON.")],
) -> None:
    """Estimate the priors of `fairyring contour --method map` from checked labels.

    Example: `fairyring priors instances.json --out priors.json`
    """
    from model.contour.estimate import estimate_priors
    from model.contour.priors import write_priors

    document = read_json(labels)
    with _named(labels):
        found = estimate_priors(document, source=labels.name)
    write_priors(found, out)
    typer.echo(f"Priors from {labels} in {out}", err=True)


def evaluate_centres(
    predicted: Annotated[Path, typer.Argument(metavar="PRED.json[.gz]", help="Caps with centres.")],
    truth: Annotated[Path, typer.Argument(metavar="TRUTH.json[.gz]", help="Caps with true centres.")],
    *,
    by: Annotated[PairBy, typer.Option(help="Pair by mask (IoU 0.5 or more) or by id.")] = PairBy.iou,
    as_json: AsJson = False,
) -> None:
    """Compare centres: the coordinate deviation rate of section 6.3 (CDR, %), pixels, error over diameter.

    Example: `fairyring evaluate centres centres.json truth.json --by id --json`
    """
    from model.evaluate import evaluate_centres as compare

    sides = read_json(predicted), read_json(truth)
    with _named(predicted, truth):
        figures = compare(*sides, by=by.value)
    if as_json:
        typer.echo(json.dumps(figures))
    else:
        _print_figures(figures)


def read_json(path: Path) -> Any:
    """The JSON in a file, gzipped or not; FileError with its name where there is none."""
    try:
        raw = path.read_bytes()
        return json.loads(gzip.decompress(raw) if raw[:2] == b"\x1f\x8b" else raw)
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}.") from error
    except (ValueError, EOFError, zlib.error, RecursionError) as error:
        raise FileError(f"{path} is not a JSON file, or was cut off; export it again.") from error


def write_json(document: Any, path: Path) -> None:
    """Writes beside and renames, so that a file is there whole or not at all."""
    raw = json.dumps(document).encode()
    beside = path.with_name(path.name + ".part")
    try:
        beside.write_bytes(gzip.compress(raw, mtime=0) if path.suffix == ".gz" else raw)
        beside.replace(path)
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}.") from error


@contextmanager
def _named(*paths: Path) -> Iterator[None]:
    """Puts the files' names before what is wrong with them."""
    try:
        yield
    except FairyringError as error:
        raise FileError(f"{' or '.join(map(str, paths))}: {error}") from error


def _print_figures(figures: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("", "mean", "median", "p95", title="centres")
    for key, title in (("cdr", "CDR, %"), ("px", "pixels"), ("relative", "error / diameter")):
        spread = figures[key]
        table.add_row(title, *(_shown(spread[name]) for name in ("mean", "median", "p95")))
    console = Console()
    console.print(table)
    bias = figures["bias_px"]
    shift = "" if bias is None else f", mean shift {bias[0]:+.3f}, {bias[1]:+.3f} px"
    console.print(
        f"{figures['matched']} matched, {figures['missed']} missed, {figures['extra']} extra{shift}"
    )


def _shown(figure: float | None) -> str:
    return "" if figure is None else f"{figure:.4f}"
