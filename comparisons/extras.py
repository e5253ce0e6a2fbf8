"""The libraries that the package can do without, and the extra that installs each."""

from typing import NamedTuple


class Extra(NamedTuple):
    """An extra of the package: its name, as in ``pip install 'tsm-crossval[NAME]'``, and what needs the library."""

    name: str
    use: str


EXTRAS = {
    "distributed": Extra("cluster", "studies on a Dask cluster (--workers ADDRESS)"),
    "openseespy": Extra("peers", "--model opensees"),
    "exudyn": Extra("peers", "--model exudyn"),
    "felupe": Extra("peers", "--model felupe"),
}
"""By library."""


def install(library: str) -> str:
    """Return how a library that cannot be imported is installed; a part of a library, as ``pyvista.core``, belongs to it."""
    extra = EXTRAS.get(library.partition(".")[0])
    return "install tsm-crossval again" if extra is None else f"install tsm-crossval[{extra.name}]"
