"""The processes that train together: one, or as many as ``torchrun`` started."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import torch
from torch import distributed


@dataclass(frozen=True)
class Process:
    """This process among those that train together."""

    rank: int = 0
    world: int = 1
    device: torch.device = field(default_factory=lambda: torch.device("cpu"))

    @property
    def leads(self) -> bool:
        """Whether it is the one that writes files and validates."""
        return self.rank == 0

    def wait(self) -> None:
        """Waits until all processes have come this far."""
        if self.world > 1:
            distributed.barrier()


@contextmanager
def together(device: torch.device) -> Iterator[Process]:
    """This process; with ``torchrun`` each gets a GPU of its own where ``device`` is one."""
    world = int(os.environ.get("WORLD_SIZE", "1"))
    if world == 1:
        yield Process(device=device)
        return
    on_gpu = device.type == "cuda"
    if on_gpu:
        device = torch.device("cuda", int(os.environ["LOCAL_RANK"]))
        torch.cuda.set_device(device)
    distributed.init_process_group("nccl" if on_gpu else "gloo")
    try:
        yield Process(rank=int(os.environ["RANK"]), world=world, device=device)
    finally:
        distributed.destroy_process_group()
