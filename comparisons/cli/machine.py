"""Whether this machine has what the commands use."""

import shutil
import sys
from collections.abc import Iterator
from importlib import metadata

from comparisons.extras import EXTRAS

NEEDED = ("numpy", "scipy", "scikit-fem", "meshio", "matplotlib", "jinja2")


def examined() -> Iterator[tuple[str, str, str]]:
    """Yield how each thing is marked, its name, and its version or what is missing: Python, distributions, extras, programs, OpenGL."""
    version = ".".join(map(str, sys.version_info[:3]))
    yield "ok" if sys.version_info >= (3, 11) else "MISSING", "python", version
    for name in NEEDED:
        found = _version(name)
        yield "ok" if found else "MISSING", name, found or "missing"
    optional = {name: (_version(name), f"extra {extra.name}: {extra.use}") for name, extra in EXTRAS.items()}
    optional["ccx"] = (
        shutil.which("ccx"),
        "Debian's calculix-ccx: --model calculix, crossval run peers",
    )
    for name, (found, use) in optional.items():
        yield "ok" if found else "-", name, found or f"missing, {use}"
    from comparisons.show.render import renders

    if renders():
        yield "ok", "OpenGL", "off-screen rendering works"
    else:
        yield "-", "OpenGL", "missing: no picture of stressed bodies, by compare and view"


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None
