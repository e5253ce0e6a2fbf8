"""The libraries that the package can do without, and the extra that installs each."""

EXTRAS = {
    "distributed": ("cluster", "studies on a Dask cluster (--workers ADDRESS)"),
    "openseespy": ("peers", "--model opensees"),
    "exudyn": ("peers", "--model exudyn"),
    "felupe": ("peers", "--model felupe"),
}
"""By library: the extra's name, as in ``pip install 'tsm-crossval[NAME]'``, and what needs the library."""


def install(library: str) -> str:
    """Return how a library that cannot be imported is installed; a part of a library, as ``pyvista.core``, belongs to it."""
    extra, _ = EXTRAS.get(library.partition(".")[0], (None, None))
    return f"install tsm-crossval[{extra}]" if extra else "install tsm-crossval again"
