"""Change sets: the edits and changes of status that one person made on one image in one go."""

from __future__ import annotations

from sqlalchemy import ColumnElement, Connection, insert, select

from fairyring.storage.cap_validity import check_name
from fairyring.storage.db.schema import change_set, edit
from fairyring.storage.records import Edit, StatusEdit, Verdict


class ChangeSets:
    """The numbers of the change sets that one person's edits belong to; entered when first asked for."""

    def __init__(self, connection: Connection, *, user: str) -> None:
        self._connection = connection
        self._user = user
        self._known: dict[tuple[int, str], int] = {}
        self._unnamed: dict[int, str] = {}

    def number_of(self, made: Edit | StatusEdit | Verdict, *, time: str) -> int:
        """The number of an edit's change set. Edits that name none are together in one an image."""
        name = made.change_set or self._unnamed.setdefault(made.image, made.id)
        takes_back = "" if isinstance(made, Verdict) else made.takes_back
        return self.number(made.image, name, takes_back=takes_back, time=time)

    def number(self, image: int, name: str, *, takes_back: str = "", time: str) -> int:
        """The number of the change set of this name, made at ``time`` unless it is there already."""
        key = (image, name)
        if key not in self._known:
            self._known[key] = self._find(*key) or self._enter(*key, takes_back=takes_back, time=time)
        return self._known[key]

    def _find(self, image: int, name: str) -> int | None:
        """One of which a piece was stored before."""
        table = change_set
        asked = select(table.c.sequence).where(
            table.c.image == image, table.c.user == self._user, table.c.id == name
        )
        return self._connection.execute(asked).scalar_one_or_none()

    def _enter(self, image: int, name: str, *, takes_back: str, time: str) -> int:
        values = {"id": name, "image": image, "user": self._user, "made_at": time}
        entered = insert(change_set).values(**values, takes_back=takes_back or None)
        return self._connection.execute(entered.returning(change_set.c.sequence)).scalar_one()


def is_edit_of(image_id: int) -> ColumnElement[bool]:
    """Whether an edit is of an image.

    The change sets of the image lead to its edits, which hold whole caps and take long to read through.
    """
    return edit.c.change_set.in_(select(change_set.c.sequence).where(change_set.c.image == image_id))


def check_change_set(made: Edit | StatusEdit | Verdict) -> None:
    """Raises StoreError where what an edit says of change sets cannot be their number."""
    for name in (made.change_set, "" if isinstance(made, Verdict) else made.takes_back):
        if name:
            check_name(name, "number of a change set")
