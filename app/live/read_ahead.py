"""Documents read ahead: the images somebody is likely to open next, kept for as long as they are current."""

from __future__ import annotations

from collections import OrderedDict

import msgspec
from sqlalchemy import Connection

from fairyring.storage.documents import load_document, load_version
from fairyring.storage.images import get_image
from fairyring.storage.records import Document

MOST_KEPT = 16


class Documents:
    """The documents read last. A version in the store tells whether one is still current."""

    def __init__(self) -> None:
        self._kept: OrderedDict[int, tuple[int, Document]] = OrderedDict()

    def load(self, connection: Connection, image_id: int) -> tuple[int, Document]:
        """The document as the store holds it now, and its version. Raises StoreError where there is none."""
        version = load_version(connection, image_id)
        kept = self._kept.get(image_id)
        if kept is not None and kept[0] == version:
            # A change of status does not count as a new version.
            return version, msgspec.structs.replace(kept[1], image=get_image(connection, image_id))
        document = load_document(connection, image_id)
        self._kept[image_id] = (version, document)
        self._kept.move_to_end(image_id)
        while len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
        return version, document
