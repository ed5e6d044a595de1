"""Divides images among splits at random."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping

from sqlalchemy import Connection

from fairyring.model.splits import Split
from fairyring.model.train.split import shared_out
from fairyring.storage.images import ImageFilter, get_image, list_ids


def divided_at_random(
    connection: Connection, image_ids: Collection[int], shares: Mapping[Split, float], *, seed: int
) -> dict[int, str | None]:
    """The split of each of these images, for ``set_splits``; copies of one photo are in one.

    Of a photo that has a copy among the other images, the split of that copy. The same images and seed give
    the same splits, in whichever order they are named.

    Args:
        connection: to the project.
        image_ids: those to divide.
        shares: how much each split gets; only their ratio counts.
        seed: of the random numbers.
    """
    asked: defaultdict[str, list[int]] = defaultdict(list)
    elsewhere: dict[str, str] = {}
    for number in list_ids(connection, ImageFilter()):
        image = get_image(connection, number)
        if number in image_ids:
            asked[image.sha256].append(number)
        elif image.split is not None:
            elsewhere[image.sha256] = image.split
    files = sorted(file for file in asked if file not in elsewhere)
    splits = dict(zip(files, shared_out(files, shares, seed=seed), strict=True))
    return {
        number: elsewhere[file] if file in elsewhere else splits[file].value
        for file, numbers in asked.items()
        for number in numbers
    }
