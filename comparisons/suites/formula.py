"""Formulas and sentences that stand in tables, in the language of Jinja."""

from functools import cache
from typing import Any


@cache
def _language() -> Any:
    from jinja2 import Environment, StrictUndefined

    language = Environment(undefined=StrictUndefined)  # noqa: S701 - Markdown; pages escape their cells
    language.trim_blocks = language.keep_trailing_newline = True
    return language


@cache
def _compiled_formula(text: str) -> Any:
    return _language().compile_expression(text, undefined_to_none=False)


@cache
def _compiled_template(text: str) -> Any:
    return _language().from_string(text)


def value_of(formula: str, **names: Any) -> Any:
    """Return the value of a formula in what its names stand for.

    >>> value_of("a ** 2 - b.c | abs", a=3.0, b={"c": -1.0})
    8.0
    """
    return _compiled_formula(formula)(**names)


def sentence(template: str, **names: Any) -> str:
    """Return the words of a template.

    >>> sentence("{{ '%.2f' % a }} m", a=1.0)
    '1.00 m'
    """
    return str(_compiled_template(template).render(names))
