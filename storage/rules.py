"""The rules of a project: how people work in it."""

from __future__ import annotations

from sqlalchemy import Connection, select, update

from fairyring.storage.db.schema import project
from fairyring.storage.records import Rules


def rules_of(connection: Connection) -> Rules:
    """The rules as they are; those of a new project where nobody has set any."""
    return connection.execute(select(project.c.rules)).scalar_one() or Rules()


def set_rules(connection: Connection, rules: Rules) -> None:
    """Keeps these rules, within ``Project.write``."""
    connection.execute(update(project).values(rules=rules))
