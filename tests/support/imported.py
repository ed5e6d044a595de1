"""What an import has left behind: rows, files, annotations, and what it complains of."""

import sqlite3

from fairyring.storage.contents import load_annotations


def rows_of(project):
    """Every row of every table, to see that nothing was changed."""
    with sqlite3.connect(project.folder / "project.db") as connection:
        tables = [
            name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        ]
        return {table: connection.execute(f"SELECT * FROM {table}").fetchall() for table in tables}


def files_of(project):
    return sorted(str(file.relative_to(project.images)) for file in project.images.rglob("*"))


def annotations_of(project, image=1):
    with project.read() as connection:
        return load_annotations(connection, image)


def reasons(report):
    return [problem.reason for problem in report.problems]
