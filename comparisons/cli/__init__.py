"""The command ``crossval``: one module for each of its commands."""

from comparisons.cli.command import main

__all__ = ["main"]
