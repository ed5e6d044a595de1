"""The ``fairyring`` command: puts the commands together and turns errors into sentences and exit codes."""

from __future__ import annotations

import logging
import os
import sys
from typing import Annotated

import typer

from fairyring.app.commands import (
    agreement,
    benchmarks,
    contour,
    demo,
    evaluate,
    images,
    imports,
    info,
    predict,
    project,
    review,
    rules,
    runs,
    serve,
    splits,
    synth,
    train,
)
from fairyring.app.commands.ending import Commands
from fairyring.app.commands.version import print_version
from fairyring.app.review.what_cdr_is import ABOUT
from fairyring.model.errors import FairyringError

app = typer.Typer(
    name="fairyring",
    cls=Commands,
    help="Correct mushroom labels in the browser, and know where every cap's centre is.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # importing rich takes longer than everything else --help needs
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("init")(project.init)
app.command("import")(imports.import_)
app.command("serve")(serve.serve)
app.command("export")(project.export)
app.command("take-out")(images.take_out)
app.command("put-back")(images.put_back)
app.command("relink")(images.relink)
app.command("split")(splits.split)
app.command("info")(info.info)
app.command("backup")(project.backup)
app.command("restore")(project.restore)
app.command("demo")(demo.demo)
app.command("synth")(synth.synth)
app.command("train")(train.train)
app.command("predict")(predict.predict)
app.command("contour")(contour.contour)
app.command("priors")(contour.priors)
app.command("review", epilog=ABOUT)(review.review)
app.command("rules")(rules.rules)
app.command("agreement")(agreement.agreement)
app.add_typer(evaluate.commands, name="evaluate")
app.add_typer(runs.commands, name="runs")
app.add_typer(benchmarks.commands, name="bench")


@app.callback()
def _root(
    *,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Log what happens, on stderr.")] = False,
    debug: Annotated[
        bool, typer.Option("--debug", help="Show where in the program an unexpected error happened.")
    ] = False,
    _version: Annotated[
        bool, typer.Option("--version", callback=print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    logging.basicConfig(
        level=logging.INFO if verbose or debug else logging.WARNING,
        format="%(levelname)s %(name)s: %(message)s",
        stream=sys.stderr,
    )


def main() -> None:
    """Runs a command. Exit code 0: done, 1: failed, with a sentence on stderr, 2: wrong use, 130: stopped."""
    # PyTorch's threads would otherwise wait for each other by counting as fast as they can, which takes the
    # cores from whatever they wait for: on a busy machine training took fifteen times as long.
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
    try:
        app()
    except FairyringError as error:
        typer.echo(f"fairyring: {error}", err=True)
        sys.exit(1)
