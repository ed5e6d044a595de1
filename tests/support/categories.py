"""Categories, as something small to write and to find again."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from pathlib import Path

from sqlalchemy import Connection

from fairyring.storage.db import schema


def insert_category(name: str) -> Callable[[Connection], object]:
    """A write that adds a category."""
    return lambda connection: connection.execute(schema.category.insert().values(name=name, extra={}))


def category_names(database: Path) -> list[str]:
    """What is in the file, read past the product."""
    with sqlite3.connect(database) as connection:
        return [name for (name,) in connection.execute("SELECT name FROM category ORDER BY id")]
