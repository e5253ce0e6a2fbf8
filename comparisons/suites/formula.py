"""Formulas and sentences that stand in tables, in the language of Jinja."""

from functools import cache
from typing import Any


@cache
def _language() -> Any:
    from jinja2 import Environment, StrictUndefined

    # Markdown; pages escape their cells
    return Environment(undefined=StrictUndefined, trim_blocks=True, keep_trailing_newline=True)  # noqa: S701


@cache
def _compiled(kind: str, text: str, **how: bool) -> Any:
    return getattr(_language(), kind)(text, **how)


def value_of(formula: str, **names: Any) -> Any:
    """Return the value of a formula in what its names stand for.

    >>> value_of("a ** 2 - b.c | abs", a=3.0, b={"c": -1.0})
    8.0
    """
    return _compiled("compile_expression", formula, undefined_to_none=False)(**names)


def sentence(template: str, **names: Any) -> str:
    """Return the words of a template.

    >>> sentence("{{ '%.2f' % a }} m", a=1.0)
    '1.00 m'
    """
    return str(_compiled("from_string", template).render(names))
