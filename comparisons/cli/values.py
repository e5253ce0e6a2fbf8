"""Values of the arguments, checked by the rules of the scene where they are read."""

import argparse
from collections.abc import Callable, Iterator
from typing import TypeVar

from comparisons.scene import rules
from comparisons.scene.rules import RuleError

Value = TypeVar("Value")


class Quantities:
    """The names of the quantities, which are imported where they are asked for; those of the path with `path`."""

    def __init__(self, *, path: bool) -> None:
        self.path = path

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        from comparisons.quantities import names

        return iter(names(path=self.path))

    def __str__(self) -> str:
        return ", ".join(self)


def count(text: str) -> int:
    """Read a whole number above zero."""
    return _checked(lambda value: rules.whole_number(int(value)), text)


def part(text: str) -> float:
    """Read a number between 0 and 1."""
    return _checked(lambda value: rules.fraction(float(value)), text)


def positive(text: str) -> float:
    """Read a number above zero."""
    return _checked(lambda value: rules.positive(float(value)), text)


def mesh(text: str) -> tuple[int, int]:
    """Read the numbers of elements along and across, as ``50x2``."""
    return _checked(rules.mesh_text, text)


def _checked(read: Callable[[str], Value], text: str) -> Value:
    try:
        return read(text)
    except RuleError as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}") from None
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text}: must be a number") from None
