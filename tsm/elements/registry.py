"""The element types by name, from the files of the folder ``kinds``."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from tsm.elements import kinds
from tsm.elements.element_type import ClosedForm, ElementType


def _found() -> dict[str, ElementType]:
    """Return the types of all files, those with a mesh first."""
    modules = (import_module(f"{kinds.__name__}.{file.name}") for file in iter_modules(kinds.__path__))
    stated = sorted(
        (kind for module in modules for kind in module.ELEMENTS), key=lambda kind: not kind.meshed
    )
    names = [kind.name for kind in stated]
    assert len(set(names)) == len(names), f"element types need names of their own: {names}"
    return {kind.name: kind for kind in stated}


ELEMENTS: dict[str, ElementType] = _found()
CLOSED_FORM: dict[str, ClosedForm] = {
    name: kind for name, kind in ELEMENTS.items() if isinstance(kind, ClosedForm)
}
