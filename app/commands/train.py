"""The command ``fairyring train``."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Annotated, Any

import typer

from fairyring.app.commands.network import Device, OnDevice
from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.rows import AsJson
from fairyring.app.commands.stopping import INTERRUPTED, stopped_by_sigterm
from fairyring.model.errors import FairyringError

LABELS_HELP = "A project's folder, or COCO files, each with its photos beside it or in images/."


def train(
    sources: Annotated[list[Path], typer.Argument(metavar="PROJECT|COCO.json...", help=LABELS_HELP)],
    *,
    out: Annotated[Path, typer.Option(help="A new folder for weights, log and curves.")],
    config: Annotated[
        Path | None, typer.Option(help="TOML recipe; what it leaves out is as in the paper.")
    ] = None,
    weights: Annotated[
        str | None,
        typer.Option(
            metavar="BASE",
            help="Weights to train further, a backbone's .pth, or imagenet. "
            "For a project the shipped ones, else imagenet.",
        ),
    ] = None,
    val: Annotated[
        list[Path] | None,
        typer.Option(metavar="COCO.json", help="Validate on these (repeat for more); else on a part."),
    ] = None,
    iterations: Annotated[int | None, typer.Option(min=1, help="A tenth of them, at most, warm up.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="The same seed gives the same weights.")] = None,
    device: OnDevice = Device.auto,
    workers: Annotated[
        int | None, typer.Option(min=0, help="Processes that cut crops: one, or eight for a GPU.")
    ] = None,
    resume: Annotated[bool, typer.Option(help="Go on with the training in --out where it stopped.")] = False,
    lenient: Annotated[
        bool, typer.Option(help="Leave out labels that cannot be used instead of stopping.")
    ] = False,
    categories: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Which categories are caps (repeat for more); else mushroom."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Train the network on a project's approved images (else its annotated ones), or on COCO files.

    Splits are obeyed (fairyring split). Validated is on --val, else on images whose split is val, else on
    three tenths of the images of no split, where these are four and more.
    After Ctrl+C or SIGTERM (exit code 130), or a crash, --resume goes on. Several GPUs: start it by torchrun.

    Example: `fairyring train beds --out run --iterations 500`
    """
    leads = int(os.environ.get("RANK", "0")) == 0
    try:
        with shown_on_stderr(silent=not leads) as shown, stopped_by_sigterm(shown) as progress:
            # Torch and all takes a while to load.
            from fairyring.app.jobs.training import Asked, train_as_asked

            asked = Asked(
                config=config,
                iterations=iterations,
                seed=seed,
                weights=weights,
                val=val or (),
                resume=resume,
                lenient=lenient,
                categories=categories or (),
            )
            result = train_as_asked(
                sources,
                out,
                asked,
                device=device,
                workers=workers,
                progress=progress,
                say=lambda sentence: typer.echo(sentence, err=True) if leads else None,
            )
    except KeyboardInterrupt:
        if leads:
            typer.echo(_after_interruption(out), err=True)
        raise typer.Exit(INTERRUPTED) from None
    except FairyringError:
        if leads:
            raise
        raise typer.Exit(1) from None
    if leads and as_json:
        figures = {"weights": str(result.weights), "validation": result.figures}
        typer.echo(json.dumps(figures | {"photos": result.photos.figures()}))
    elif leads:
        typer.echo(f"Wrote {result.weights}.{_validated(result.figures)}", err=True)


def _after_interruption(out: Path) -> str:
    from fairyring.model.train.checkpoint import CHECKPOINT

    if (out / CHECKPOINT).exists():
        return f"Stopped; the same command with --resume goes on with {out}."
    return "Stopped before the first iteration was done; nothing is lost by starting anew."


def _validated(figures: dict[str, Any]) -> str:
    if not figures:
        return ""
    return f" Validation at iteration {figures['iteration']}: AP {figures['AP']:.4f}."
