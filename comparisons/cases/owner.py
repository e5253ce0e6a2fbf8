"""The process that works on a case, and the test whether it still runs."""

import os
import socket
from dataclasses import dataclass
from time import time

import psutil

LEASE = 60.0
"""Seconds without a sign of life after which a run's claims are free, whatever it does."""
CLOCK = 5.0
"""Largest difference of two readings of one process's start [s]. The system derives it from its clock, which may be set meanwhile."""


@dataclass(frozen=True, kw_only=True)
class Owner:
    """A process that runs cases.

    Parameters
    ----------
    host : str
        Name of its machine.
    pid : int
        Its number there.
    born : float
        Start of the process [s since 1970], needed because systems reuse process numbers.
    """

    host: str
    pid: int
    born: float

    @classmethod
    def this_process(cls) -> "Owner":
        """Return the owner that this process is."""
        return cls(host=socket.gethostname(), pid=os.getpid(), born=psutil.Process().create_time())

    def alive(self, heard: float) -> bool:
        """Whether the process may still work on its cases; `heard` is the time of its last sign of life.

        On this machine the process table answers. A process on another machine counts as alive for `LEASE` seconds after `heard`, and
        so does a stopped process.
        """
        if time() - heard > LEASE:
            return False
        return self.host != socket.gethostname() or self._runs()

    def _runs(self) -> bool:
        """Whether the process runs on this machine. One that ended and waits for its parent does not."""
        try:
            process = psutil.Process(self.pid)
            ended = process.status() in {psutil.STATUS_ZOMBIE, psutil.STATUS_DEAD}
            return not ended and abs(process.create_time() - self.born) <= CLOCK
        except psutil.AccessDenied:
            return True
        except psutil.NoSuchProcess:
            return False
