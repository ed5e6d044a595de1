"""The batches of a training, cut by processes of their own and handed to as many as train together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from torch.utils.data import DataLoader

from fairyring.model.network.objective import Batch
from fairyring.model.train.data import Batches, Example, SampleConfig
from fairyring.model.train.distributed import Process
from fairyring.model.train.recipe import Recipe, RecipeError


def batches_of(
    examples: Sequence[Example], recipe: Recipe, *, first: int, workers: int, process: Process
) -> Iterator[list[Batch]]:
    """This process's share of every iteration from ``first`` on, ``recipe.accumulate`` batches at a time.

    Raises RecipeError where a batch cannot be shared evenly, DataError where nothing is labelled.
    """
    if recipe.batch % process.world:
        raise RecipeError(f"A batch of {recipe.batch} cannot be shared by {process.world} processes.")
    settings = SampleConfig(
        crop=recipe.crop,
        network=recipe.network,
        batch=recipe.batch // process.world,
        soft=recipe.targets == "soft",
        seed=recipe.seed,
    )
    count = recipe.iterations * recipe.accumulate * process.world
    mine = range(first * recipe.accumulate * process.world + process.rank, count, process.world)
    loader = DataLoader(
        Batches(examples, settings, count=count),
        batch_size=None,
        sampler=mine,
        num_workers=workers,
        prefetch_factor=4 if workers else None,
    )
    gathered = []
    for batch in loader:
        gathered.append(batch)
        if len(gathered) == recipe.accumulate:
            yield gathered
            gathered = []
