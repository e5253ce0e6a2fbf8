"""Values of the arguments, checked where they are read."""

import argparse

from comparisons.scene.rules import RuleError, whole_number


def count(text: str) -> int:
    """Read a whole number above zero."""
    try:
        return whole_number(int(text))
    except RuleError as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}") from None


def part(text: str) -> float:
    """Read a number between 0 and 1."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text}: must lie between 0 and 1")
    return value


def mesh(text: str) -> tuple[int, int]:
    """Read the numbers of elements along and across, as ``50x2``."""
    along, separator, across = text.partition("x")
    if not separator:
        raise argparse.ArgumentTypeError(f"{text}: must be NXxNY, as 50x2")
    return count(along), count(across)
