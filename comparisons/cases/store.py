"""The store of a sweep: which cases are done, which are being worked on, and their results."""

import json
import sqlite3
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import time
from types import TracebackType
from typing import TYPE_CHECKING

from comparisons.cases.case import Case
from comparisons.cases.owner import Owner
from comparisons.cases.schema import database_errors, open_for_writing
from comparisons.files import OutputError
from comparisons.scene import to_toml
from comparisons.version import version

if TYPE_CHECKING:
    from comparisons.cases.measure import Measurement

WORKER_LOST = "WORKER_LOST"
"""The status of a case whose worker died, and died again when the case was tried alone."""
ERROR = "ERROR"
"""The status of a case that raised an exception, which no model should."""
UNSETTLED = (WORKER_LOST, ERROR)
"""Statuses that come from the machine or from a bug and not from the case; the next study repeats the case."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """Result of an attempt to claim cases, by their keys.

    Attributes
    ----------
    claimed : list of str
        Cases that this run has claimed.
    done : dict of str
        Recorded cases with their statuses.
    taken : list of str
        Cases that another run works on.
    """

    claimed: list[str]
    done: dict[str, str]
    taken: list[str]


class Store:
    """The results file at `path` in the hands of one run; closing it gives back what the run has claimed.

    Every method is one transaction: a process may end at any point, and any number may use one file.

    Raises
    ------
    OutputError
        One line, here and from every method: the file cannot be written, or is something else.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._connection = open_for_writing(path)
        owner = Owner.this_process()
        with self._transaction():
            self._run = self._connection.execute(
                "INSERT INTO run (host, pid, born, heard) VALUES (?, ?, ?, ?)",
                (owner.host, owner.pid, owner.born, time()),
            ).lastrowid

    def __enter__(self) -> "Store":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        # what cannot be given back is free as soon as this process is gone
        with suppress(OutputError), self._transaction():
            self._connection.execute("DELETE FROM run WHERE id = ?", (self._run,))
        self._connection.close()

    def statuses(self) -> dict[str, str]:
        """Return the status of every case that this version has recorded, by key."""
        with database_errors(self.path, "cannot be read"):
            rows = self._connection.execute(
                "SELECT key, status FROM result WHERE version = ?", (version(),)
            ).fetchall()
        return {row["key"]: row["status"] for row in rows}

    def older(self, cases: Mapping[str, Case]) -> dict[str, tuple[str, str]]:
        """Return version and status of the settled results that other versions have of `cases`, by the cases' keys.

        If several versions have a result, the last version by name is returned. A case with a mesh file or a program file has none,
        because the content of the file at that time is not known.
        """
        keys = {
            (to_toml(case.scene), case.model, options_text(case)): key
            for key, case in cases.items()
            if case.model == case.model_name and not any(beam.solid_mesh_file for beam in case.scene.beams)
        }
        with database_errors(self.path, "cannot be read"):
            rows = self._connection.execute(
                "SELECT definition, model, options, version, status FROM result "
                "WHERE version != ? AND status NOT IN (?, ?) ORDER BY version",
                (version(), *UNSETTLED),
            ).fetchall()
        found = ((keys.get((row["definition"], row["model"], row["options"])), row) for row in rows)
        return {key: (row["version"], row["status"]) for key, row in found if key is not None}

    def claim(self, keys: Iterable[str], *, limit: int, again: frozenset[str] = frozenset()) -> Claim:
        """Claim at most `limit` cases that nobody has done or is working on, in the order of `keys`.

        Those `again` names are claimed even if they are recorded. A case whose run has died is free.
        """
        found = Claim(claimed=[], done={}, taken=[])
        with self._transaction():
            self._say_alive()
            for key in keys:
                if len(found.claimed) == limit:
                    break
                recorded = self._one(
                    "SELECT status FROM result WHERE key = ? AND version = ?", key, version()
                )
                if recorded is not None and key not in again:
                    found.done[key] = recorded["status"]
                elif self._taken(key):
                    found.taken.append(key)
                else:
                    self._connection.execute("REPLACE INTO claim (key, run) VALUES (?, ?)", (key, self._run))
                    found.claimed.append(key)
        return found

    def say_alive(self) -> None:
        """Renew the lease of this run's claims."""
        with self._transaction():
            self._say_alive()

    def record(self, key: str, case: Case, measurement: "Measurement") -> None:
        """Record the result of a case and give back its claim.

        A settled result stands: where two runs did the same case, the first to finish is kept.
        """
        row = _row(key, case, measurement)
        names = ", ".join(row)
        update = ", ".join(f"{name} = excluded.{name}" for name in row if name != "key")
        with self._transaction():
            self._connection.execute(
                f"INSERT INTO result ({names}) VALUES ({', '.join('?' * len(row))}) "  # noqa: S608 - own names
                f"ON CONFLICT (key) DO UPDATE SET {update} "
                "WHERE result.status IN (?, ?) OR result.version != excluded.version",
                (*row.values(), *UNSETTLED),
            )
            self._connection.execute("DELETE FROM claim WHERE key = ? AND run = ?", (key, self._run))
            self._say_alive()

    def _say_alive(self) -> None:
        self._connection.execute("UPDATE run SET heard = ? WHERE id = ?", (time(), self._run))

    def _taken(self, key: str) -> bool:
        """Whether another run that is alive works on the case."""
        owner = self._one("SELECT run.* FROM claim JOIN run ON run.id = claim.run WHERE key = ?", key)
        if owner is None or owner["id"] == self._run:
            return False
        return Owner(host=owner["host"], pid=owner["pid"], born=float(owner["born"] or 0.0)).alive(
            owner["heard"]
        )

    def _one(self, query: str, *values: str) -> sqlite3.Row | None:
        row: sqlite3.Row | None = self._connection.execute(query, values).fetchone()
        return row

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with database_errors(self.path):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._connection.execute("COMMIT")
            except BaseException:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                raise


def options_text(case: Case) -> str:
    """Return the options given, as JSON."""
    return json.dumps({name: value for name, value in asdict(case.options).items() if value is not None})


def _row(key: str, case: Case, measurement: "Measurement") -> dict[str, object]:
    """Return the columns of a result; a number of seconds that is not there becomes null."""
    response = measurement.response
    return {
        "key": key,
        "scene": case.scene.name,
        "model": case.model_name,
        "label": case.label,
        "definition": to_toml(case.scene),
        "options": options_text(case),
        "version": version(),
        "status": response.status,
        "message": response.message,
        "completed": response.completed,
        "iterations": response.iterations,
        "cutbacks": response.cutbacks,
        "unknowns": response.unknowns,
        "seconds": measurement.seconds,
        "repeats": measurement.repeats,
        "peak_memory": measurement.peak_memory,
        "measurement": zlib.compress(measurement.to_json().encode()),
    }
