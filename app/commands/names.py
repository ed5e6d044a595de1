"""Names given on the command line: what is none is wrong use, which is said before anything is opened."""

from __future__ import annotations

from collections.abc import Callable

import typer


def checked_name(what: str) -> Callable[[str | None], str | None]:
    """A callback of typer for a name that the store will keep; ``what`` it is the name of."""

    def check(text: str | None) -> str | None:
        from fairyring.storage.cap_validity import check_name
        from fairyring.storage.errors import StoreError

        try:
            return None if text is None else check_name(text, f"name of a {what}")
        except StoreError as error:
            raise typer.BadParameter(str(error)) from None

    return check
