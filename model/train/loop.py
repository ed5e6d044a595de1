"""Training (sections 3 and 6.1): batches in, weights out, and a state to go on from after a kill.

In the output folder: ``last.pt`` to resume from, ``best.safetensors`` by the validation's AP,
``weights.safetensors`` at the end (the best, or the last where nothing was validated), ``log.jsonl``,
``curves.png``, ``run.json`` with the recipe, versions, device and duration, and ``labels.json`` with what was
learnt from.
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
from fairyring.model.network.objective import Batch, Losses, losses_of
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import save_weights
from fairyring.model.train import log as train_log
from fairyring.model.train.checkpoint import load_checkpoint, save_checkpoint
from fairyring.model.train.circumstances import Circumstances
from fairyring.model.train.data import Example
from fairyring.model.train.distributed import Process, together
from fairyring.model.train.loading import batches_of
from fairyring.model.train.optimiser import freeze_statistics, rate_at, set_rate
from fairyring.model.train.recipe import Recipe
from fairyring.model.train.second_look import SecondLosses, SecondStep
from fairyring.model.train.state import TrainingState, first_state, new_network
from fairyring.model.train.validate import calibrate, validate

BEST, FINAL, CARD, LABELS = "best.safetensors", "weights.safetensors", "run.json", "labels.json"
SEEDS = 1_000_003
"""Added to a seed for each iteration: so far apart, the iterations of two seeds never share one."""


class TrainError(FairyringError):
    """Training that cannot go on; the sentence says what to change."""


class TrainingProgress(Struct, frozen=True, kw_only=True):
    """How far a training is."""

    iteration: int
    """How many iterations are finished."""
    iterations: int
    loss: float
    what: str
    """What is done now."""


Report = Callable[[TrainingProgress], None]
"""Called after every iteration; whatever it raises ends the training, which can be resumed."""


@dataclass(frozen=True, kw_only=True)
class TrainResult:
    """What a finished training leaves."""

    weights: Path
    figures: dict[str, Any]
    """Figures of the best validation; empty where there was none."""


@dataclass(frozen=True, kw_only=True)
class _Plan:
    """What stays the same through all iterations."""

    recipe: Recipe
    checks: list[Example]
    out: Path
    card: dict[str, Any]
    process: Process
    report: Report


class _NetworkStep(nn.Module):
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
    machine, however often it was resumed.

    Raises TrainError, DivergenceError, DataError, CheckpointError, WeightsError.
    """
    with together(device) as process, _without_denormals():
        torch.manual_seed(recipe.seed)
        state = first_state(base or new_network(recipe), recipe, device=process.device)
        card = {"recipe": msgspec.to_builtins(recipe), "images": len(examples), **(notes or {})}
        checks = list(validation)[: recipe.validate_images]
        if not any(example.caps for example in checks):
            checks = []
        plan = _Plan(recipe=recipe, checks=checks, out=out, card=card, process=process, report=report)
        circumstances = _prepare(state, plan, labels, resume=resume)
        step = _step_of(state, recipe)
        # A process whose crops show no cap uses neither the kernels nor the points.
        trained = DistributedDataParallel(step, find_unused_parameters=True) if process.world > 1 else step
        try:
            if resume:
                _catch_up(state, plan)
            for batches in batches_of(
                examples, recipe, first=state.iteration, workers=workers, process=process
            ):
                losses = _iterate(state, trained, batches, plan)
                _afterwards(state, plan, losses)
                report(_progress(state, plan, losses, "training"))
        except BaseException:
            if process.leads and state.iteration and not state.stepping:
                save_checkpoint(out, state.as_checkpoint())
                circumstances.write()
            raise
        if process.leads:
            _finish(state, plan)
            circumstances.write()
        process.wait()
        return TrainResult(weights=out / FINAL, figures=state.best)


def _step_of(state: TrainingState, recipe: Recipe) -> nn.Module:
    """What gives the losses of a batch, by what is to be learnt."""
    return SecondStep(state.network) if recipe.learns == "second look" else _NetworkStep(state.network)


@contextmanager
def _without_denormals() -> Iterator[None]:
    """Treats denormal numbers as 0 within the block; in fading gradients they slow training a hundredfold."""
    torch.set_flush_denormal(True)
    try:
        yield
    finally:
        torch.set_flush_denormal(False)


def _prepare(state: TrainingState, plan: _Plan, labels: bytes | None, *, resume: bool) -> Circumstances:
    """The output folder: empty for a new training, with its checkpoint for one that goes on."""
    out, process = plan.out, plan.process
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TrainError(f"{out} cannot be made: {error.strerror or error}.") from error
    if resume:
        saved = load_checkpoint(out, device=process.device)
        try:
            state.restore(saved)
        except (KeyError, TypeError, ValueError, RuntimeError) as error:
            raise TrainError(
                f"The training in {out} had another recipe; resume with that in {out / CARD}."
            ) from error
    elif any(out.iterdir()) and process.leads:
        raise TrainError(f"{out} is not empty; give a new folder, or --resume to go on with that state.")
    process.wait()
    circumstances = Circumstances(out / CARD, plan.card, process.device, processes=process.world)
    if process.leads:
        train_log.cut_after(out, state.iteration)
        circumstances.write()
        if labels is not None:
            (out / LABELS).write_bytes(labels)
    return circumstances


def _iterate(state: TrainingState, step: nn.Module, batches: list[Batch], plan: _Plan) -> dict[str, float]:
    """One step of the optimiser; returns what the log says of it."""
    recipe, process = plan.recipe, plan.process
    began = time.monotonic()
    # All randomness of an iteration depends on its number alone, so that a resumed training repeats it.
    torch.manual_seed((recipe.seed * SEEDS + state.iteration) * process.world + process.rank)
    state.network.train()
    freeze_statistics(state.network)
    rate = rate_at(state.iteration, recipe)
    set_rate(state.optimiser, rate)
    state.optimiser.zero_grad(set_to_none=True)
    parts: list[Losses | SecondLosses] = []
    for batch in batches:
        with torch.autocast(process.device.type, torch.bfloat16, enabled=recipe.bf16):
            losses = step(batch.to(process.device))
        (losses.total / len(batches)).backward()
        parts.append(type(losses)(*(term.detach() for term in losses)))
    means = type(parts[0])(*(torch.stack(terms).mean() for terms in zip(*parts, strict=True)))
    loss = float(means.total)
    norm = float(nn.utils.clip_grad_norm_(state.network.parameters(), recipe.clip))
    if not math.isfinite(norm) or not math.isfinite(loss):
        raise TrainError(
            f"The loss is no number any more at iteration {state.iteration}; "
            "lower the rate, or lengthen the warm-up, and resume."
        )
    state.losses.add(loss, iteration=state.iteration)
    state.stepping = True
    state.optimiser.step()
    if state.average is not None:
        state.average.update_parameters(state.network)
    state.iteration += 1
    state.stepping = False
    return {
        **{name: float(term) for name, term in means._asdict().items()},
        "loss": loss,
        "rate": rate,
        "norm": norm,
        "seconds": time.monotonic() - began,
    }


def _afterwards(state: TrainingState, plan: _Plan, losses: dict[str, float]) -> None:
    """Logs an iteration; validates and saves where it is time to."""
    if plan.process.leads:
        train_log.append(plan.out, [{"iteration": state.iteration, **losses}])
        if plan.checks and _is_time(state, plan, plan.recipe.validate_every):
            _check(state, plan, losses)
        if _is_time(state, plan, plan.recipe.save_every):
            save_checkpoint(plan.out, state.as_checkpoint())
            train_log.draw_curves(plan.out)
    plan.process.wait()


def _is_time(state: TrainingState, plan: _Plan, every: int) -> bool:
    return state.iteration == plan.recipe.iterations or state.iteration % every == 0


def _catch_up(state: TrainingState, plan: _Plan) -> None:
    """Does the validation that the training was stopped in."""
    due = (
        plan.checks and state.checked < state.iteration and _is_time(state, plan, plan.recipe.validate_every)
    )
    if due and plan.process.leads:
        losses = [entry for entry in train_log.read(plan.out) if "rate" in entry]
        _check(state, plan, losses[-1])
    plan.process.wait()


def _check(state: TrainingState, plan: _Plan, losses: dict[str, float]) -> None:
    """Validates, and keeps the weights where they are the best so far."""

    def say(_done: int, _total: int, what: str) -> None:
        plan.report(_progress(state, plan, losses, what))

    validation = validate(state.kept, plan.checks, device=plan.process.device, progress=say)
    calibrate(state.kept, validation)
    found = {name: value for name, value in validation.figures.items() if isinstance(value, float)}
    train_log.append(plan.out, [{"iteration": state.iteration, **found}])
    state.checked = state.iteration
    if not state.best or found["AP"] > state.best["AP"]:
        state.best = {"iteration": state.iteration, **found}
        _save(state, plan, plan.out / BEST)


def _finish(state: TrainingState, plan: _Plan) -> None:
    if (plan.out / BEST).exists():
        shutil.copyfile(plan.out / BEST, plan.out / FINAL)
    else:
        _save(state, plan, plan.out / FINAL)


def _save(state: TrainingState, plan: _Plan, path: Path) -> None:
    figures = {"iteration": state.iteration, "validation": state.best}
    save_weights(path, state.kept.state_dict(), state.network.config, card={**plan.card, **figures})


def _progress(state: TrainingState, plan: _Plan, losses: dict[str, float], what: str) -> TrainingProgress:
    return TrainingProgress(
        iteration=state.iteration,
        iterations=plan.recipe.iterations,
        loss=losses["loss"],
        what=what,
    )
