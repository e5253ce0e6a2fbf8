"""Names of beams and pins, and the places in the file where they stand."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

from comparisons.scene.record import Unjudged
from comparisons.scene.rules import FieldError, shown

if TYPE_CHECKING:
    from comparisons.scene.beam import BeamSpec
    from comparisons.scene.records import Scene

Named = TypeVar("Named", bound=Any)


class ByName(dict[str, Named]):
    """Records by their names; a name that none has raises `Unjudged`, a ``KeyError``."""

    def __missing__(self, name: str) -> Named:
        """Raise `Unjudged`."""
        raise Unjudged(name)


def by_name(records: Iterable[Named]) -> ByName[Named]:
    """Return records by their names, without those whose name is wrong."""
    named = ByName[Named]()
    for record in records:
        with suppress(Unjudged):
            named[record.name] = record
    return named


def listed(names: Iterable[str]) -> str:
    """Return names as they stand in a file, separated by commas; "there is none" if there are none."""
    return ", ".join(shown(name) for name in names) or "there is none"


class Names:
    """Places of beams and pins, as ``beam[0]``, by their names.

    A name that appears twice cannot be judged. A name that nothing has cannot be judged either, where another name is wrong or
    appears twice.

    Parameters
    ----------
    scene : Scene
        All beams and pins.

    Attributes
    ----------
    scene : Scene
        The scene.
    repeated : list of FieldError
        Names that appear twice.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self._places: dict[str, str] = {}
        self._twice: set[str] = set()
        self._complete = True
        self.repeated: list[FieldError] = []
        for kind in ("beam", "pin"):
            try:
                self._add(kind, getattr(scene, f"{kind}s"))
            except Unjudged:
                self._complete = False

    def _add(self, kind: str, records: Iterable[Any]) -> None:
        for i, record in enumerate(records):
            try:
                name = record.name
            except Unjudged:
                self._complete = False
                continue
            if name in self._places:
                self._twice.add(name)
                self._complete = False
                self.repeated.append(FieldError(f"{kind}[{i}].name", name, "must not appear twice"))
            else:
                self._places[name] = f"{kind}[{i}]"

    def place(self, name: str) -> str:
        """Return the place of the beam or pin called `name`.

        Raises
        ------
        Unjudged
            If there is none, or the name appears twice.
        """
        if name in self._twice or name not in self._places:
            raise Unjudged(name)
        return self._places[name]

    def is_beam(self, name: str) -> bool:
        """Whether `name` is that of a beam.

        Raises
        ------
        Unjudged
            If the name appears twice, or is that of no beam while another name is wrong or appears twice.
        """
        return self._is(name, "beam")

    def is_pin(self, name: str) -> bool:
        """Whether `name` is that of a pin; raises `Unjudged` as `is_beam` does."""
        return self._is(name, "pin")

    def is_node(self, node: str) -> bool:
        """Whether `node` is a pin's name, or a beam's end as ``upper.end``; raises `Unjudged` as `is_beam` does."""
        name, dot, end = node.partition(".")
        return self._is(name, "beam" if dot else "pin") and (end in ("start", "end") or not dot)

    def _is(self, name: str, kind: str) -> bool:
        found = self._places.get(name, "").startswith(kind)
        if name in self._twice or not (found or self._complete):
            raise Unjudged(name)
        return found

    def beam(self, name: str) -> BeamSpec:
        """Return the beam called `name`.

        Raises
        ------
        Unjudged
            If there is none.
        """
        if not self.is_beam(name):
            raise Unjudged(name)
        return self.scene.beam(name)

    def not_a_beam(self, key: str, name: str) -> Iterator[FieldError]:
        """Yield a mistake if `name`, which stands at `key`, is not that of a beam."""
        if not self.is_beam(name):
            yield FieldError(key, name, f"must name a beam: {listed(self.beams())}")

    def beams(self) -> Iterator[str]:
        """Yield the names of the beams."""
        return (name for name, place in self._places.items() if place.startswith("beam"))

    def pins(self) -> Iterator[str]:
        """Yield the names of the pins."""
        return (name for name, place in self._places.items() if place.startswith("pin"))

    def nodes(self) -> Iterator[str]:
        """Yield the names of the pins, then the ends of the beams."""
        yield from self.pins()
        yield from (f"{beam}.{end}" for beam in self.beams() for end in ("start", "end"))
