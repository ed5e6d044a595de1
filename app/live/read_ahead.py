"""Images read ahead: those somebody is likely to open next, kept for as long as they are current."""

from __future__ import annotations

from collections import OrderedDict

import msgspec
from sqlalchemy import Connection

from fairyring.storage.contents import load_contents, load_version
from fairyring.storage.images import get_image
from fairyring.storage.records import ImageContents
from fairyring.storage.runs import get_run

MOST_KEPT = 16


class RecentImages:
    """The contents of the images read last. A version in the store tells whether one is still current."""

    def __init__(self) -> None:
        self._kept: OrderedDict[int, tuple[int, ImageContents]] = OrderedDict()

    def load(self, connection: Connection, image_id: int) -> tuple[int, ImageContents]:
        """An image's contents as the store holds them now, and their version.

        Raises StoreError where the project has no such image.
        """
        version = load_version(connection, image_id)
        kept = self._kept.get(image_id)
        if kept is not None and kept[0] == version:
            # A change of status, or of a run's name, does not count as a new version.
            run = None if kept[1].run is None else get_run(connection, kept[1].run.id)
            image = get_image(connection, image_id)
            return version, msgspec.structs.replace(kept[1], image=image, run=run)
        contents = load_contents(connection, image_id)
        self._kept[image_id] = (version, contents)
        self._kept.move_to_end(image_id)
        while len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
        return version, contents
