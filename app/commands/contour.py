"""Commands on masks: whole outlines and centres, and their priors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fairyring.app.commands.files import named, require_other_file, write_json
from fairyring.app.commands.progress import steps_shown, time_told
from fairyring.model.contour.method_names import MethodName

Labels = Annotated[Path, typer.Argument(metavar="COCO.json[.gz]", help="COCO file with checked outlines.")]


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
    from fairyring.model.coco.document import read_document
    from fairyring.model.contour.coco import contour_document
    from fairyring.model.contour.priors import DEFAULT, read_priors

    require_other_file(out, masks, *([priors] if priors else ()))
    document = read_document(masks)
    chosen = read_priors(priors) if priors else DEFAULT
    with steps_shown() as progress, named(masks):
        found = contour_document(document, method=method, priors=chosen, progress=progress)
    write_json(found, out)
    caps = [cap for cap in found["annotations"] if isinstance(cap, dict)]
    refused = sum(cap["center"] is None for cap in caps)
    typer.echo(f"{len(caps)} caps in {out}, {refused} of them refused", err=True)


def priors(
    labels: Labels,
    *,
    out: Annotated[Path, typer.Option(help="Where to write the priors, as JSON.")],
) -> None:
    """Estimate the priors of `fairyring contour --method map` from checked labels.

    Example: `fairyring priors instances.json --out priors.json`
    """
    from fairyring.model.coco.document import read_document
    from fairyring.model.contour.estimate import estimate_priors
    from fairyring.model.contour.priors import write_priors

    require_other_file(out, labels)
    document = read_document(labels)
    with named(labels), time_told("Estimating priors"):
        found = estimate_priors(document, source=labels.name)
    write_priors(found, out)
    typer.echo(f"Priors from {labels} in {out}", err=True)
