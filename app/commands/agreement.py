"""``fairyring agreement``: two people's labels of the same photos, compared and brought together."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.files import is_same_file, named, write_json
from fairyring.app.commands.rows import AsJson, print_rows
from fairyring.app.how_many import how_many

if TYPE_CHECKING:
    from fairyring.model.evaluate.agreement import Agreement
    from fairyring.model.evaluate.bootstrap import Interval
    from fairyring.model.evaluate.kappa import Kappa

Labels = Annotated[Path, typer.Argument(metavar="COCO.json[.gz]", help="What one person labelled.")]


def agreement(
    first: Labels,
    second: Labels,
    *,
    adjudicated: Annotated[
        Path | None,
        typer.Option(metavar="OUT.json", help="Write a third version, in which what differs is doubtful."),
    ] = None,
    agree_from: Annotated[
        float, typer.Option(min=0, max=1, metavar="IOU", help="From which on outlines are the same.")
    ] = 0.85,
    as_json: AsJson = False,
) -> None:
    """Compare what two people labelled in the same photos: matched caps, outlines, centres, flags.

    In the third version stands what both agree on as the first has it, and all else as doubtful: import it
    with --replace and decide on the doubtful caps at the reviewer's desk. Both files stay as they are.

    Example: `fairyring agreement ada.json ben.json --adjudicated third.json`
    """
    from msgspec import to_builtins

    from fairyring.model.coco.document import read_document
    from fairyring.model.evaluate.agreement import adjudicated as third_version
    from fairyring.model.evaluate.agreement import agreement_of, versions_of

    if adjudicated is not None and any(is_same_file(adjudicated, each) for each in (first, second)):
        raise typer.BadParameter(
            "the third version would take the place of one of the two; name another file",
            param_hint="--adjudicated",
        )
    ours, theirs = read_document(first), read_document(second)
    with named(first, second):
        versions = versions_of(ours, theirs)
    found = agreement_of(versions)
    if adjudicated is not None:
        document = third_version(ours, versions, least_iou=agree_from)
        write_json(document, adjudicated)
        open_ = sum("doubt" in entry for entry in document["annotations"])
        caps = how_many(len(document["annotations"]), "cap")
        typer.echo(f"{caps} in {adjudicated}, {open_} to be decided", err=True)
    if as_json:
        typer.echo(json.dumps(to_builtins(found)))
        return
    print_rows(f"{first.name} and {second.name}", agreement_lines(found), as_json=False)


def agreement_lines(found: Agreement) -> list[dict[str, Any]]:
    """How far two people agree, line by line."""
    counts = (
        ("matched", found.matched),
        ("only first", found.only_first),
        ("only second", found.only_second),
    )
    return [
        *({"figure": name, "value": str(count), "95 of 100": ""} for name, count in counts),
        *(_mean_line(name, of) for name, of in (("IoU", found.iou), ("px", found.px), ("CDR, %", found.cdr))),
        _kappa_line("kappa, ignored", found.ignored),
        _kappa_line("kappa, doubtful", found.doubtful),
    ]


def _mean_line(name: str, of: Interval | None) -> dict[str, Any]:
    if of is None:
        return {"figure": name, "value": "–", "95 of 100": ""}
    return {"figure": name, "value": f"{of.mean:.3f}", "95 of 100": f"{of.low:.3f} to {of.high:.3f}"}


def _kappa_line(name: str, of: Kappa) -> dict[str, Any]:
    if of.kappa is None or of.low is None or of.high is None:
        return {"figure": name, "value": "–", "95 of 100": "both always said the same" if of.count else ""}
    return {"figure": name, "value": f"{of.kappa:.3f}", "95 of 100": f"{of.low:.3f} to {of.high:.3f}"}
