"""A project: a folder with ``fairyring.toml``, ``project.db`` and ``images/``.

There is one writer thread, and a write is on disk when it returns. Readers see the state before or
after a write, never between.
"""

from __future__ import annotations

import json
import threading
import tomllib
from collections.abc import Callable, Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar
from uuid import uuid4

from sqlalchemy import Connection, insert, select

from fairyring.storage.db import schema
from fairyring.storage.db.clock import now
from fairyring.storage.db.engine import connect_engine, explained, warn_of_network_drive
from fairyring.storage.db.upgrade import upgrade
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import DATABASE, IMAGES, SETTINGS, is_project
from fairyring.storage.originals import Originals

T = TypeVar("T")


class Project:
    """An open project. Safe to use from any thread; ``close`` it, or use it in a ``with``."""

    def __init__(self, folder: Path, url: str) -> None:
        self.folder = folder
        self.url = url
        self.originals = Originals(folder)
        self._readers = connect_engine(url, write=False)
        self._writer = connect_engine(url, write=True)
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="store")
        with self.read() as connection:
            row = connection.execute(select(schema.project)).one()
        self.id: str = row.id
        self.name: str = row.name

    @property
    def images(self) -> Path:
        """Folder of the copied images."""
        return self.folder / IMAGES

    @contextmanager
    def read(self) -> Generator[Connection]:
        """A connection that sees one state of the project until it is left.

        Raises:
            StoreError: the database cannot be read.
        """
        with explained(str(self.folder)), self._readers.connect() as connection:
            yield connection

    def write(self, work: Callable[[Connection], T]) -> T:
        """Runs ``work`` in one transaction on the writer thread; on disk when this returns.

        Whatever ``work`` raises rolls everything back and is raised here.

        Raises:
            StoreError: a full or failing disk, or a database locked by another program.
        """
        if threading.current_thread().name.startswith("store"):
            raise RuntimeError("write() within write(): hand the connection on instead")
        return self._thread.submit(self._transact, work).result()

    def _transact(self, work: Callable[[Connection], T]) -> T:
        with explained(str(self.folder)), self._writer.begin() as connection:
            return work(connection)

    def written_by_others(self) -> int | None:
        """A number that changes when another process writes; None where the database cannot tell."""
        if self._writer.dialect.name != "sqlite":
            return None
        return self._thread.submit(self._data_version).result()

    def _data_version(self) -> int:
        """As the writer's own connection sees it, for which its own transactions do not count."""
        connection = self._writer.raw_connection()
        try:
            (version,) = connection.cursor().execute("PRAGMA data_version").fetchone()
        finally:
            connection.close()  # back into the pool of one
        return version

    def close(self) -> None:
        """Waits for the writes under way, then lets go of the database."""
        self._thread.shutdown(wait=True)
        self._writer.dispose()
        self._readers.dispose()

    def __enter__(self) -> Project:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def create_project(folder: Path, *, url: str | None = None) -> Project:
    """Makes ``folder`` (which may exist) a project and opens it.

    Args:
        folder: where; its name becomes the project's.
        url: an SQLAlchemy URL of an empty database; by default an SQLite file in the folder.

    Raises:
        StoreError: it is a project already, or the folder or database cannot be written.
    """
    if is_project(folder):
        raise StoreError(f"{folder} is a Fairyring project already; open it, or choose another folder.")
    try:
        (folder / IMAGES).mkdir(parents=True, exist_ok=True)
        database = url or _sqlite_url(folder)
        upgrade(database, source=folder)
        _enter_names(database, name=folder.resolve().name, shared=url is not None)
        (folder / SETTINGS).write_text(_settings(folder.resolve().name, url), encoding="utf-8")
    except OSError as error:
        raise StoreError(f"{folder} cannot be made a project: {error.strerror}.") from error
    return open_project(folder)


def open_project(folder: Path) -> Project:
    """Opens a project, first bringing an older database up to date (a backup is made beside it).

    Raises:
        StoreError: not a project; made by a newer Fairyring; damaged; not readable.
    """
    settings = _read_settings(folder)
    url = settings.get("store", {}).get("url")
    if url is None:
        if not (folder / DATABASE).is_file():
            raise StoreError(f"{folder} has no {DATABASE}; restore it from a backup, or make a new project.")
        warn_of_network_drive(folder)
    database = url or _sqlite_url(folder)
    upgrade(database, source=folder, existing=None if url else folder / DATABASE)
    return Project(folder, database)


def back_up(project: Project, out: Path) -> None:
    """Writes the database as it is now, whole and compact, into the new file ``out``.

    Raises:
        StoreError: ``out`` exists or cannot be written, or the project is not kept in SQLite.
    """
    if out.exists():
        raise StoreError(f"{out} exists already; name a new file for the backup.")
    if not project.url.startswith("sqlite"):
        raise StoreError(
            f"{project.folder} is kept in a database server; back it up with the server's own tools."
        )
    if not out.parent.is_dir():
        raise StoreError(f"{out.parent} is not a folder; make it first, or name another file for the backup.")
    engine = connect_engine(project.url, write=False)
    try:
        with explained(str(out)):
            raw = engine.raw_connection()
            raw.cursor().execute("VACUUM INTO ?", (str(out),))
            raw.close()
    finally:
        engine.dispose()


def _sqlite_url(folder: Path) -> str:
    return f"sqlite:///{(folder / DATABASE).resolve()}"


def _enter_names(url: str, *, name: str, shared: bool) -> None:
    engine = connect_engine(url, write=True)
    try:
        with explained(name), engine.begin() as connection:
            named = connection.execute(select(schema.project.c.id)).first()
            if named and shared:
                raise StoreError(f"The database for {name} holds a project already; give an empty one.")
            # A folder's own database that has a name has only lost its settings file: it is taken over.
            if not named:
                connection.execute(insert(schema.project).values(id=uuid4().hex, name=name, made_at=now()))
    finally:
        engine.dispose()


def _settings(name: str, url: str | None) -> str:
    lines = ["# A Fairyring project.", "[project]", f"name = {json.dumps(name, ensure_ascii=False)}"]
    if url is not None:
        lines += ["", "[store]", f"url = {json.dumps(url, ensure_ascii=False)}"]
    return "\n".join(lines) + "\n"


def _read_settings(folder: Path) -> dict:
    path = folder / SETTINGS
    if not path.is_file():
        raise StoreError(f"{folder} is not a Fairyring project; make one with: fairyring init {folder}")
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StoreError(f"{path} cannot be read: {error}. Put it right in a text editor.") from error
