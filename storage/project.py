"""A project: a folder with ``fairyring.toml``, ``project.db`` and ``images/``.

There is one writer thread, and a write is on disk when it returns. Readers see the state before or
after a write, never between.
"""

from __future__ import annotations

import json
import os
import threading
import tomllib
from collections.abc import Callable, Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from tempfile import TemporaryDirectory
from typing import TypeVar
from uuid import uuid4

from sqlalchemy import URL, Connection, insert, make_url, select

from fairyring.storage.db import schema
from fairyring.storage.db.clock import now
from fairyring.storage.db.copying import copy_read_only
from fairyring.storage.db.engine import connect_engine, explained, warn_of_network_drive
from fairyring.storage.db.upgrade import check_is_project, holds_nothing, make_tables, upgrade
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import CACHE, DATABASE, IMAGES, NOTE_OF_BACKUP, SETTINGS, is_project
from fairyring.storage.originals import Originals

T = TypeVar("T")


class Project:
    """An open project. Safe to use from any thread; ``close`` it, or use it in a ``with``."""

    def __init__(self, folder: Path, url: str | URL, *, copy: TemporaryDirectory[str] | None = None) -> None:
        self.folder = folder
        self.url = url
        self._copy = copy
        self.originals = Originals(folder)
        self._readers = connect_engine(url, write=False)
        self._writer = connect_engine(url, write=True)
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="store")
        with self.read() as connection:
            row = connection.execute(select(schema.project)).one()
        self.id: str = row.id
        self.name: str = row.name

    @property
    def read_only(self) -> bool:
        """Whether nothing may be stored; then everything is read from a copy of how it was when opened."""
        return self._copy is not None

    @property
    def cache(self) -> Path:
        """Folder of what can be made anew; of a read-only project one that goes when it is closed."""
        return (Path(self._copy.name) if self._copy else self.folder) / CACHE

    @property
    def sqlite_file(self) -> Path | None:
        """Where the database lies; None where a server keeps it."""
        url = make_url(self.url)
        return Path(url.database) if url.get_backend_name() == "sqlite" and url.database else None

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

        Whatever ``work`` raises rolls everything back and is raised here. So does Ctrl+C, unless it comes
        when all is stored already: then it is passed over.

        Raises:
            StoreError: a full or failing disk, a database locked by another program, or a read-only project.
        """
        self.require_writable()
        return self.keep(work)

    def keep(self, work: Callable[[Connection], T]) -> T:
        """The same for what can be worked out again, as whole outlines.

        A read-only project keeps it in the copy it is read from, which goes when it is closed.

        Raises:
            StoreError: as ``write``.
        """
        if threading.current_thread().name.startswith("store"):
            raise RuntimeError("write() within write(): hand the connection on instead")
        stopped = threading.Event()
        transaction = self._thread.submit(self._transact, work, stopped)
        try:
            return transaction.result()
        except KeyboardInterrupt:
            # Ctrl+C reaches whoever waits; what follows must know whether this was stored.
            stopped.set()
            return transaction.result()

    def require_writable(self) -> None:
        """Raises StoreError where nothing may be stored."""
        if self.read_only:
            raise StoreError(f"{self.folder} is read-only; make its folder and files writable to change it.")

    def _transact(self, work: Callable[[Connection], T], stopped: threading.Event) -> T:
        with explained(str(self.folder)), self._writer.begin() as connection:
            done = work(connection)
            if stopped.is_set():
                raise KeyboardInterrupt
            return done

    def written_by_others(self) -> int | None:
        """A number that changes when another process writes; None where the database cannot tell."""
        if self.read_only or self._writer.dialect.name != "sqlite":
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
        if self._copy is not None:
            self._copy.cleanup()

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
        StoreError: it is a project already, holds another database, or cannot be written.
    """
    if is_project(folder):
        raise StoreError(f"{folder} is a Fairyring project already; open it, or choose another folder.")
    try:
        if url is None:
            if (folder / DATABASE).exists() and not _is_hardly_begun(folder):
                check_is_project(folder / DATABASE)
            (folder / IMAGES).mkdir(parents=True, exist_ok=True)
        database = url or _own_database(folder)
        with _gone_if_stopped(folder / DATABASE):
            make_tables(database, source=folder)
        (folder / IMAGES).mkdir(parents=True, exist_ok=True)
        _enter_names(database, name=folder.resolve().name, shared=url is not None)
        fresh = folder / f"{SETTINGS}.part"
        fresh.write_text(_settings(folder.resolve().name, url), encoding="utf-8")
        fresh.replace(folder / SETTINGS)  # whole or not at all: a folder that has it is a project
    except OSError as error:
        raise StoreError(f"{folder} cannot be made a project: {error.strerror}.") from error
    return open_project(folder)


@contextmanager
def _gone_if_stopped(database: Path) -> Generator[None]:
    """Removes a database that is made in the block if that is not done."""
    was_there = database.exists()
    try:
        yield
    except BaseException:
        if not was_there:
            database.unlink(missing_ok=True)
        raise


def _is_hardly_begun(folder: Path) -> bool:
    """Whether somebody who made the folder a project was stopped before anything was in it."""
    images = folder / IMAGES
    return holds_nothing(folder / DATABASE) and not (images.is_dir() and any(images.iterdir()))


def open_project(folder: Path) -> Project:
    """Opens a project, first bringing an older database up to date (a backup is made beside it).

    Where its folder or database may not be written to, it is opened read-only.

    Raises:
        StoreError: not a project; made by a newer Fairyring; damaged; not readable.
    """
    if (folder / NOTE_OF_BACKUP).exists():
        raise StoreError(
            f"{folder} is a backup; make a project of it with: fairyring restore {quote(str(folder))} PROJECT"
        )
    settings = _read_settings(folder)
    url = settings.get("store", {}).get("url")
    if url is not None:
        upgrade(url, source=folder)
        return Project(folder, url)
    file = folder / DATABASE
    if not file.is_file():
        raise StoreError(f"{folder} has no {DATABASE}; restore it from a backup, or make a new project.")
    if not all(os.access(path, os.W_OK, effective_ids=True) for path in (folder, file)):
        return _open_read_only(folder)
    warn_of_network_drive(folder)
    upgrade(_own_database(folder), source=folder, file=file)
    return Project(folder, _own_database(folder))


def _open_read_only(folder: Path) -> Project:
    """Reads from a copy: SQLite would write beside a database even to read it, or take it for unchanging."""
    copy = TemporaryDirectory(prefix="fairyring-")
    try:
        copy_read_only(folder / DATABASE, Path(copy.name) / DATABASE)
        url = _own_database(Path(copy.name))
        upgrade(url, source=folder)
        return Project(folder, url, copy=copy)
    except BaseException:
        copy.cleanup()
        raise


def _own_database(folder: Path) -> URL:
    # As text, a question mark in the name of a folder would end it.
    return URL.create("sqlite", database=str((folder / DATABASE).resolve()))


def _enter_names(url: str | URL, *, name: str, shared: bool) -> None:
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
        raise StoreError(
            f"{folder} is not a Fairyring project; make one with: fairyring init {quote(str(folder))}"
        )
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StoreError(f"{path} cannot be read: {error}. Put it right in a text editor.") from error
