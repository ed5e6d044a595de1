"""Training (sections 3 and 6.1): batches in, weights out, and a state to go on from after a kill.

In the output folder: ``last.pt`` to resume from, ``best.safetensors`` by the validation's AP,
``weights.safetensors`` at the end (the best, or the last where nothing was validated), ``log.jsonl``,
``curves.png``, ``run.json`` with the recipe, and ``labels.json`` with what was learnt from.
"""

from __future__ import annotations

import math
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import torch
from msgspec import Struct
from torch import nn
from torch.nn.parallel import DistributedDataParallel

from fairyring.model.errors import FairyringError
from fairyring.model.network.losses import DICE_WEIGHT
from fairyring.model.network.objective import Batch, Losses, losses_of
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import save_weights
from fairyring.model.train import log as train_log
from fairyring.model.train.checkpoint import load_checkpoint, save_checkpoint
from fairyring.model.train.data import Example
from fairyring.model.train.distributed import Place, together
from fairyring.model.train.loading import batches_of
from fairyring.model.train.optimiser import freeze_statistics, rate_at, set_rate
from fairyring.model.train.recipe import Recipe
from fairyring.model.train.state import Run, new_network, start_run
from fairyring.model.train.validate import validate

BEST, FINAL, RUN, LABELS = "best.safetensors", "weights.safetensors", "run.json", "labels.json"
SEEDS = 1_000_003
"""Apart from each other, the seeds of two runs' iterations do not meet."""


class TrainError(FairyringError):
    """Training that cannot go on; the sentence says what to change."""


class Progress(Struct, frozen=True, kw_only=True):
    """Where a run stands."""

    iteration: int
    """Finished ones."""
    iterations: int
    loss: float
    what: str
    """What is done now."""


Report = Callable[[Progress], None]
"""Called after every iteration; whatever it raises ends the run, which can be resumed."""


@dataclass(frozen=True, kw_only=True)
class TrainResult:
    """What a finished run left."""

    weights: Path
    figures: dict[str, Any]
    """Of the best validation; empty where there was none."""


@dataclass(frozen=True, kw_only=True)
class _Plan:
    """What stays the same through all iterations."""

    recipe: Recipe
    checks: list[Example]
    out: Path
    card: dict[str, Any]
    place: Place
    report: Report


class _Step(nn.Module):
    """Forward pass and losses as one module, which several processes can share the gradients of."""

    def __init__(self, network: PRSOLOv2) -> None:
        super().__init__()
        self.network = network

    def forward(self, batch: Batch) -> Losses:
        return losses_of(self.network, self.network(batch.photos, batch.origins), batch)


def train(
    examples: Sequence[Example],
    validation: Sequence[Example],
    out: Path,
    *,
    recipe: Recipe,
    device: torch.device,
    base: PRSOLOv2 | None = None,
    resume: bool = False,
    workers: int = 1,
    notes: dict[str, Any] | None = None,
    labels: bytes | None = None,
    report: Report = lambda _: None,
) -> TrainResult:
    """Trains on crops of ``examples``; keeps what does best on ``validation``, whole photos or nothing.

    ``base`` is trained further where given (and changed), else a new network starts from ImageNet weights
    if they are installed. ``workers`` processes cut crops. ``notes`` go into ``run.json`` and the weights'
    card, ``labels`` into ``labels.json``. The same examples, recipe and seed give the same weights on one
    machine, however often the run was resumed.

    Raises TrainError, DataError, CheckpointError, WeightsError.
    """
    with together(device) as place, _faded_is_nought():
        torch.manual_seed(recipe.seed)
        run = start_run(base or new_network(recipe), recipe, device=place.device)
        card = {"recipe": msgspec.to_builtins(recipe), "images": len(examples), **(notes or {})}
        checks = list(validation)[: recipe.validate_images]
        if not any(example.caps for example in checks):
            checks = []
        plan = _Plan(recipe=recipe, checks=checks, out=out, card=card, place=place, report=report)
        _prepare(run, plan, labels, resume=resume)
        step = _Step(run.network)
        # A process whose crops show no cap uses neither the kernels nor the points.
        trained = DistributedDataParallel(step, find_unused_parameters=True) if place.world > 1 else step
        try:
            if resume:
                _catch_up(run, plan)
            for batches in batches_of(examples, recipe, first=run.iteration, workers=workers, place=place):
                losses = _iterate(run, trained, batches, plan)
                _afterwards(run, plan, losses)
                report(_progress(run, plan, losses, "training"))
        except BaseException:
            if place.leads and run.iteration and not run.stepping:
                save_checkpoint(out, run.state())
            raise
        if place.leads:
            _finish(run, plan)
        place.wait()
        return TrainResult(weights=out / FINAL, figures=run.best)


@contextmanager
def _faded_is_nought() -> Iterator[None]:
    """Gradients that fade out would otherwise be counted with at a hundredth of the speed."""
    torch.set_flush_denormal(True)
    try:
        yield
    finally:
        torch.set_flush_denormal(False)


def _prepare(run: Run, plan: _Plan, labels: bytes | None, *, resume: bool) -> None:
    """The output folder: empty for a new run, with its checkpoint for one that goes on."""
    out, place = plan.out, plan.place
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TrainError(f"{out} cannot be made: {error.strerror or error}.") from error
    if resume:
        state = load_checkpoint(out, device=place.device)
        try:
            run.load(state)
        except (KeyError, TypeError, ValueError, RuntimeError) as error:
            raise TrainError(
                f"The run in {out} had another recipe; resume with that in {out / RUN}."
            ) from error
    elif any(out.iterdir()) and place.leads:
        raise TrainError(f"{out} is not empty; give a new folder, or --resume to go on with that run.")
    place.wait()
    if place.leads:
        train_log.cut_after(out, run.iteration)
        (out / RUN).write_bytes(msgspec.json.format(msgspec.json.encode(plan.card), indent=2))
        if labels is not None:
            (out / LABELS).write_bytes(labels)


def _iterate(run: Run, step: nn.Module, batches: list[Batch], plan: _Plan) -> dict[str, float]:
    """One step of the optimiser; returns what the log says of it."""
    recipe, place = plan.recipe, plan.place
    began = time.monotonic()
    # Everything drawn in this iteration depends on its number alone, so that a resumed run draws the same.
    torch.manual_seed((recipe.seed * SEEDS + run.iteration) * place.world + place.rank)
    run.network.train()
    freeze_statistics(run.network)
    rate = rate_at(run.iteration, recipe)
    set_rate(run.optimiser, rate)
    run.optimiser.zero_grad(set_to_none=True)
    parts = []
    for batch in batches:
        with torch.autocast(place.device.type, torch.bfloat16, enabled=recipe.bf16):
            losses = step(batch.to(place.device))
        (losses.total / len(batches)).backward()
        parts.append(torch.stack([term.detach() for term in losses]))
    category, mask, points = torch.stack(parts).mean(0).tolist()
    norm = float(nn.utils.clip_grad_norm_(run.network.parameters(), recipe.clip))
    if not math.isfinite(norm) or not math.isfinite(category + mask + points):
        raise TrainError(
            f"The loss is no number any more at iteration {run.iteration}; "
            "lower the rate, or lengthen the warm-up, and resume."
        )
    run.stepping = True
    run.optimiser.step()
    if run.average is not None:
        run.average.update_parameters(run.network)
    run.iteration += 1
    run.stepping = False
    return {
        "category": category,
        "mask": mask,
        "points": points,
        "rate": rate,
        "norm": norm,
        "seconds": time.monotonic() - began,
    }


def _afterwards(run: Run, plan: _Plan, losses: dict[str, float]) -> None:
    """Logs an iteration; validates and saves where it is time to."""
    if plan.place.leads:
        train_log.append(plan.out, [{"iteration": run.iteration, **losses}])
        if plan.checks and _is_time(run, plan, plan.recipe.validate_every):
            _check(run, plan, losses)
        if _is_time(run, plan, plan.recipe.save_every):
            save_checkpoint(plan.out, run.state())
            train_log.draw_curves(plan.out)
    plan.place.wait()


def _is_time(run: Run, plan: _Plan, every: int) -> bool:
    return run.iteration == plan.recipe.iterations or run.iteration % every == 0


def _catch_up(run: Run, plan: _Plan) -> None:
    """The validation that the run was stopped in."""
    due = plan.checks and run.checked < run.iteration and _is_time(run, plan, plan.recipe.validate_every)
    if due and plan.place.leads:
        losses = [entry for entry in train_log.read(plan.out) if "rate" in entry]
        _check(run, plan, losses[-1])
    plan.place.wait()


def _check(run: Run, plan: _Plan, losses: dict[str, float]) -> None:
    """Validates, and keeps the weights where they are the best so far."""

    def say(_done: int, _total: int, what: str) -> None:
        plan.report(_progress(run, plan, losses, what))

    validation = validate(run.kept, plan.checks, device=plan.place.device, progress=say)
    run.kept.calibration.copy_(torch.tensor(validation.calibration))
    found = {name: value for name, value in validation.figures.items() if isinstance(value, float)}
    train_log.append(plan.out, [{"iteration": run.iteration, **found}])
    run.checked = run.iteration
    if not run.best or found["AP"] > run.best["AP"]:
        run.best = {"iteration": run.iteration, **found}
        _save(run, plan, plan.out / BEST)


def _finish(run: Run, plan: _Plan) -> None:
    if (plan.out / BEST).exists():
        shutil.copyfile(plan.out / BEST, plan.out / FINAL)
    else:
        _save(run, plan, plan.out / FINAL)


def _save(run: Run, plan: _Plan, path: Path) -> None:
    figures = {"iteration": run.iteration, "validation": run.best}
    save_weights(path, run.kept.state_dict(), run.network.config, card={**plan.card, **figures})


def _progress(run: Run, plan: _Plan, losses: dict[str, float], what: str) -> Progress:
    return Progress(
        iteration=run.iteration,
        iterations=plan.recipe.iterations,
        loss=losses["category"] + DICE_WEIGHT * losses["mask"] + losses["points"],
        what=what,
    )
