"""The file of a sweep's results: an SQLite database, recognised, made and opened without harm to any other file."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep

from comparisons.files import OutputError, writable_file

APPLICATION = 0x54534D58
"""The application id in the header of the SQLite file ("TSMX"), which marks it as a results file."""
VERSION = 3
"""Version of the tables and of their contents."""
PATIENCE = 60.0
"""Seconds to wait for other writers."""

TABLES = f"""
CREATE TABLE run (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    host TEXT NOT NULL, pid INTEGER NOT NULL, born TEXT NOT NULL,   -- the process, start [s since 1970]
    heard REAL NOT NULL                                             -- last sign of life [s since 1970]
);
CREATE TABLE claim (
    key TEXT PRIMARY KEY,                                           -- of the case that is worked on
    run INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE
) WITHOUT ROWID;
CREATE TABLE result (
    key TEXT PRIMARY KEY,                                           -- Case.key
    scene TEXT NOT NULL, model TEXT NOT NULL, label TEXT NOT NULL,
    definition TEXT NOT NULL,                                       -- the whole scene as TOML
    options TEXT NOT NULL,                                          -- the options given, as JSON
    version TEXT NOT NULL,                                          -- of this package
    status TEXT NOT NULL, message TEXT NOT NULL, completed INTEGER NOT NULL,
    iterations INTEGER NOT NULL, cutbacks INTEGER NOT NULL, unknowns INTEGER NOT NULL,
    seconds REAL, repeats INTEGER NOT NULL, peak_memory INTEGER NOT NULL,
    measurement BLOB NOT NULL                                       -- Measurement.to_json, deflated by zlib
) WITHOUT ROWID;
PRAGMA application_id = {APPLICATION};
PRAGMA user_version = {VERSION};
"""


@contextmanager
def database_errors(path: Path, what: str = "cannot be written") -> Iterator[None]:
    """Turn the errors of SQLite into one line."""
    try:
        yield
    except sqlite3.Error as error:
        raise OutputError(f"{path}: {what}: {error}") from None


def open_for_writing(path: Path) -> sqlite3.Connection:
    """Open the results file `path`, made if it is not there.

    Raises
    ------
    OutputError
        If it cannot be written, or is something else, which is then left as it is.
    """
    path = writable_file(path)
    with database_errors(path):
        connection, recognised = _open(path, "mode=rwc")
        try:
            if not recognised:
                _into_wal(connection)
                _make(connection, path)
        except BaseException:
            connection.close()
            raise
    return connection


def open_for_reading(path: Path) -> sqlite3.Connection:
    """Open the results file `path`, also where nothing can be written.

    Raises
    ------
    OutputError
        If there is none, or it is something else.
    """
    if not path.is_file():
        raise OutputError(f"{path}: cannot be read: there is no such file")
    with database_errors(path, "cannot be read"):
        try:
            # a reader that could not write would leave the files of the WAL behind
            connection, recognised = _open(path, "mode=rw")
        except sqlite3.OperationalError:
            if path.with_name(f"{path.name}-wal").exists():
                raise
            # the folder cannot be written in, and nobody does
            connection, recognised = _open(path, "immutable=1")
    if not recognised:
        connection.close()
        raise OutputError(f"{path}: cannot be read: holds no results of crossval")
    return connection


def _open(path: Path, mode: str) -> tuple[sqlite3.Connection, bool]:
    """Return a connection to the file, and whether it has this schema."""
    connection = sqlite3.connect(
        f"{path.resolve().as_uri()}?{mode}", uri=True, timeout=PATIENCE, isolation_level=None
    )
    try:
        connection.row_factory = sqlite3.Row
        # in WAL mode, a killed process loses nothing; a crash of the machine may lose the last transactions
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("PRAGMA foreign_keys = ON")
        return connection, _recognised(connection, path)
    except BaseException:
        connection.close()
        raise


def _make(connection: sqlite3.Connection, path: Path) -> None:
    """Make the tables, unless another process was faster."""
    connection.execute("BEGIN IMMEDIATE")
    if not _recognised(connection, path):
        for statement in TABLES.split(";"):
            connection.execute(statement)
    connection.execute("COMMIT")


def _recognised(connection: sqlite3.Connection, path: Path) -> bool:
    """Whether the file has this schema; false if it is empty.

    Raises
    ------
    OutputError
        If it holds something else or a newer schema.
    """
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    if application != APPLICATION:
        if application or version or tables:
            raise OutputError(f"{path}: is no results file of crossval, but another SQLite database")
        return False
    if version != VERSION:
        raise OutputError(
            f"{path}: has schema {version}, this version of crossval reads {VERSION}: choose another file"
        )
    return True


def _into_wal(connection: sqlite3.Connection) -> None:
    """Let readers and one writer work at the same time; SQLite does not wait for others here by itself."""
    deadline = monotonic() + PATIENCE
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
        except sqlite3.OperationalError:
            if monotonic() > deadline:
                raise
            sleep(0.02)
        else:
            return
