"""Whether this machine has what the commands use."""

import shutil
import sys
from collections.abc import Iterator
from importlib import metadata
from typing import NamedTuple

from comparisons.extras import EXTRAS

NEEDED = ("numpy", "scipy", "scikit-fem", "meshio", "matplotlib")
PROGRAMS = {"ccx": "Debian's calculix-ccx: --model calculix, crossval run peers"}


class Finding(NamedTuple):
    """One thing looked at.

    Attributes
    ----------
    what, state : str
        Its name, and a version or what is missing.
    well : bool or None
        Whether it is there; None where it is missing and nothing but an extra needs it.
    """

    what: str
    state: str
    well: bool | None


def examined() -> Iterator[Finding]:
    """Yield the findings: Python, distributions, extras, programs, OpenGL."""
    version = ".".join(map(str, sys.version_info[:3]))
    yield Finding("python", version, sys.version_info >= (3, 11))
    for name in NEEDED:
        found = _version(name)
        yield Finding(name, found or "missing", found is not None)
    for name, extra in EXTRAS.items():
        found = _version(name)
        yield Finding(name, found or f"missing, extra {extra.name}: {extra.use}", True if found else None)
    for name, use in PROGRAMS.items():
        path = shutil.which(name)
        yield Finding(name, path or f"missing, {use}", True if path else None)
    yield _opengl()


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _opengl() -> Finding:
    from comparisons.show.render import renders

    found = renders()
    state = "off-screen rendering works" if found else "missing: pictures by matplotlib instead of pyvista"
    return Finding("OpenGL", state, True if found else None)
