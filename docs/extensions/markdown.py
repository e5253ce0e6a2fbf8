"""Markdown from docstrings and tables."""

import re
from collections.abc import Iterable, Sequence


def text(docstring: str) -> str:
    r"""Return one line of Markdown for a docstring's text: code marks and what Markdown would read as its own.

    Examples
    --------
    >>> text("a name, ``pin->beam``, of `Beam` * 2")
    'a name, `pin->beam`, of `Beam` \\* 2'
    """
    parts = re.split(r"(``[^`]+``|`[^`]+`)", " ".join(docstring.split()))
    return "".join(
        f"`{part.strip('`')}`" if part.startswith("`") else re.sub(r"([*_<\[{$|\\])", r"\\\1", part)
        for part in parts
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; cells are Markdown in one line."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(_cell(cell) for cell in line) + " |" for line in lines)


def _cell(markdown: str) -> str:
    return re.sub(r"(?<!\\)\|", r"\\|", markdown)
