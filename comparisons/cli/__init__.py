"""The command ``crossval``: one module for each of its commands."""

from comparisons.cli.command import main

__all__ = ["main"]


def __dir__() -> list[str]:
    return sorted(__all__)
