"""The command that renders a set of beds."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.progress import steps_shown
from fairyring.model.light_and_form import LightSource

if TYPE_CHECKING:
    from fairyring.model.scene.settings import Settings


def synth(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="A new or empty folder.")],
    *,
    count: Annotated[int | None, typer.Option(help="How many beds: 24, of preset paper 480.", min=1)] = None,
    seed: Annotated[int, typer.Option(help="The same seed gives the same beds.", min=0)] = 1,
    preset: Annotated[
        str, typer.Option(help="default, paper (the paper's data set), farm or mixed.")
    ] = "default",
    light: Annotated[list[LightSource] | None, typer.Option(help="Only this light; repeat for more.")] = None,
    form: Annotated[
        list[str] | None, typer.Option(help="Only this form, a to h; repeat for more, `ac` for both in one.")
    ] = None,
    config: Annotated[Path | None, typer.Option(help="TOML file of settings laid over the preset.")] = None,
    jobs: Annotated[int | None, typer.Option(help="Processes: one a core.", min=1)] = None,
    resume: Annotated[bool, typer.Option(help="Continue a set that was stopped, or add to it.")] = False,
) -> None:
    """Render beds of mushrooms whose hidden outlines are known, as images and one COCO file.

    Example: `fairyring synth beds --count 100 --seed 7 --light side --form d`
    """
    from fairyring.model.scene.dataset import write_beds

    settings = _settings(preset, config, light=light, form=form)
    count = count or (480 if preset == "paper" else 24)
    with steps_shown() as progress:
        rendered = write_beds(
            out, settings, count=count, seed=seed, jobs=jobs or _cores(), resume=resume, progress=progress
        )
    typer.echo(f"{count} beds in {out}, {rendered} of them rendered now", err=True)


def _settings(
    preset: str, config: Path | None, *, light: list[LightSource] | None, form: list[str] | None
) -> Settings:
    from fairyring.model.scene.presets import preset as preset_of
    from fairyring.model.scene.settings import changed

    settings = changed(preset_of(preset), _tables(config)) if config else preset_of(preset)
    chosen: dict[str, Any] = {}
    if light:
        chosen["lights"] = light
    if form:
        chosen["forms"] = form
    return changed(settings, chosen)


def _tables(config: Path) -> dict[str, Any]:
    import tomllib

    from fairyring.model.scene.settings import SceneError

    try:
        return tomllib.loads(config.read_text())
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SceneError(f"{config} cannot be read as TOML: {error}.") from error


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
