"""Provenance of a result: the release, a digest of the sources, the libraries and the machine."""

import os
import platform
from functools import cache
from importlib.util import find_spec
from pathlib import Path

PACKAGES = ("tsm", "fem_reference", "comparisons")
DISTRIBUTIONS = ("numpy", "scipy", "scikit-fem", "tsm-crossval")


def release() -> str:
    """Return the release of the installed distribution."""
    from importlib import metadata

    return metadata.version("tsm-crossval")


@cache
def version() -> str:
    """Return the release and a digest of the sources, as ``0.5.1+1a2b3c4d``; equal versions have equal source files."""
    import hashlib  # 2 ms that only a study needs

    found = hashlib.sha256()
    for package in PACKAGES:
        spec = find_spec(package)
        for folder in map(Path, (spec and spec.submodule_search_locations) or ()):
            for path in sorted(folder.rglob("*.py")):
                found.update(f"{package}/{path.relative_to(folder).as_posix()}\0".encode())
                found.update(path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return f"{release()}+{found.hexdigest()[:8]}"


def versions() -> dict[str, str]:
    """Return the versions of Python and of the installed packages that compute the numbers."""
    from importlib import metadata

    found = {name: metadata.version(name) for name in DISTRIBUTIONS}
    return {"python": platform.python_version(), **found}


def machine() -> dict[str, str]:
    """Return the machine that wall times are measured on: system, processor and number of cores."""
    return {
        "system": platform.platform(),
        "processor": _processor() or platform.processor() or platform.machine(),
        "cores": str(os.cpu_count() or "unknown"),
    }


def _processor() -> str:
    """Name of the processor, where Linux states it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return ""
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
