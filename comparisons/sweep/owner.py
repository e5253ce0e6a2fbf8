"""Who works on a case: a process, and whether it is still there."""

import os
import socket
from dataclasses import dataclass
from pathlib import Path
from time import time

LEASE = 60.0
"""Seconds without a sign of life after which a run's claims are free, whatever it does."""


@dataclass(frozen=True, kw_only=True)
class Owner:
    """A process that runs cases.

    Parameters
    ----------
    host : str
        Name of its machine.
    pid : int
        Its number there.
    born : str
        When it was started, in the machine's own count, since numbers of processes are used again; empty where the system
        does not tell.
    """

    host: str
    pid: int
    born: str

    @classmethod
    def this_process(cls) -> "Owner":
        """Return the owner that this process is."""
        return cls(host=socket.gethostname(), pid=os.getpid(), born=_born(os.getpid()))

    def alive(self, heard: float) -> bool:
        """Whether it may still be at work, last heard of at the time `heard`.

        On this machine a process is asked for; one on another machine, or one that has stopped, is believed for `LEASE`.
        """
        if time() - heard > LEASE:
            return False
        return self.host != socket.gethostname() or (_exists(self.pid) and _born(self.pid) == self.born)


def _exists(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _born(pid: int) -> str:
    """Return the start time of a process, field 22 of Linux's /proc/PID/stat; empty elsewhere, or if it is gone or dead."""
    try:
        state, *rest = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except (OSError, ValueError):
        return ""
    return "" if state in "ZX" else rest[18]
