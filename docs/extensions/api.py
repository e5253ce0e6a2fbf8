"""The public names of the packages, from what they export."""

import importlib
import inspect
from types import ModuleType

MODULES = {
    "tsm": ("tsm",),
    "fem_reference": ("fem_reference",),
    "comparisons": (
        "comparisons.scene",
        "comparisons.models",
        "comparisons.models.options",
        "comparisons.response",
        "comparisons.models.verify",
        "comparisons.errors",
        "comparisons.compare",
        "comparisons.accuracy",
        "comparisons.claims.gate",
        "comparisons.claims.manual",
        "comparisons.exact",
        "comparisons.models.translate",
        "comparisons.show.export",
        "comparisons.cases",
        "comparisons.budget",
    ),
}
"""The modules of each page."""


def page(package: str) -> str:
    """Return the public names of a package's modules in the order of ``__all__``, or of the source."""
    return "\n\n".join(_section(importlib.import_module(name)) for name in MODULES[package]) + "\n"


def _section(module: ModuleType) -> str:
    about = (module.__doc__ or "").partition("\n")[0]
    lines = ["```{eval-rst}", f".. py:module:: {module.__name__}", ""]
    for name in public_names(module):
        value = getattr(module, name)
        directive, options = _directive(value)
        lines += [f".. {directive}:: {module.__name__}.{name}", *(f"   :{option}:" for option in options), ""]
        if isinstance(value, dict):
            lines += ["   Keys: " + ", ".join(f"``{key}``" for key in value) + ".", ""]
    return f"## `{module.__name__}`\n\n{about}\n\n" + "\n".join(lines) + "```"


def public_names(module: ModuleType) -> list[str]:
    """Return ``__all__``, or the documented classes and functions that a module defines itself."""
    if hasattr(module, "__all__"):
        return list(module.__all__)
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_")
        and (inspect.isclass(value) or inspect.isfunction(value))
        and value.__module__ == module.__name__
    ]


def _directive(value: object) -> tuple[str, tuple[str, ...]]:
    if inspect.isclass(value):
        return ("autoexception" if issubclass(value, BaseException) else "autoclass"), ("members",)
    return ("autofunction", ()) if inspect.isfunction(value) else ("autodata", ("no-value",))
