"""The splits that images belong to: set for an image and all copies of its photo, and as they were before."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy import Connection, select, update

from fairyring.storage.cap_validity import check_name
from fairyring.storage.db.rows import require_image
from fairyring.storage.db.schema import image
from fairyring.storage.errors import StoreError


def set_splits(connection: Connection, splits: Mapping[int, str | None]) -> dict[int, str | None]:
    """Gives images their splits, and the same to all images of the same file; None for none.

    Returns every image that is in another split now, with the one it was in: given back to this function,
    that undoes it.

    Raises:
        StoreError: there is no such image, a split has no name, or two copies of one photo were to be in two
            splits. Nothing is changed then.
    """
    by_file: dict[str, str | None] = {}
    for number, split in splits.items():
        if split is not None:
            check_name(split, "name of a split")
        row = require_image(connection, number)
        if by_file.setdefault(row.sha256, split) != split:
            raise StoreError(
                f"{row.file_name} and a copy of it were to be in two splits; put all copies into one."
            )
    before: dict[int, str | None] = {}
    for row in connection.execute(select(image.c.id, image.c.sha256, image.c.split)):
        if row.sha256 in by_file and row.split != by_file[row.sha256]:
            before[row.id] = row.split
            changed = update(image).where(image.c.id == row.id)
            connection.execute(changed.values(split=by_file[row.sha256]))
    return before
