"""Numbers that the pages state, each behind a mark with its name: ``<!--name-->1.5e-5``. `make results` writes them anew.

A mark names the numbers that follow it, up to the next mark; a name may stand on several pages. A test measures the numbers of
a name and judges them as a claim on every page, at the digits stated there.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Decimal
from pathlib import Path

from comparisons.claims.claim import Allowance, Claim, Quantity, judge
from comparisons.files import alone_in, write_text

ROOT = Path(__file__).parents[1]
MARK = re.compile(r"<!--([a-z][\w.-]*)-->")
NUMBER = re.compile(r"(?<![\w.`-])(-?(?:\d{1,3}(?:,\d{3})+|\d*\.?\d+(?:e-?\d+)?))(?![\w`])( %)?")


ROUND_OFF = 1.5
"""Factor that a processor may add to a stated bound of round-off."""


def pages() -> list[Path]:
    """Return the README and the documentation's pages."""
    written = sorted((ROOT / "docs").rglob("*.md"))
    return [ROOT / "README.md", *(page for page in written if "_generated" not in page.parts)]


@dataclass(frozen=True)
class Stated:
    """A number as a page states it, and where it stands in the page's text."""

    text: str
    percent: bool
    start: int
    end: int

    @property
    def unit(self) -> float:
        """0.01 of a number in per cent."""
        return 0.01 if self.percent else 1.0

    @property
    def value(self) -> float:
        return float(self.text.replace(",", "")) * self.unit

    @property
    def decimals(self) -> int:
        return len(self.text.partition("e")[0].partition(".")[2])

    @property
    def half_unit(self) -> float:
        """Half a unit of the last digit."""
        exponent = int(self.text.partition("e")[2] or 0)
        return 0.5 * 10.0 ** (exponent - self.decimals) * self.unit

    def rewritten(self, value: float, *, up: bool) -> str:
        """Return a value with as many digits and in the same form, rounded up if it is a bound.

        Examples
        --------
        >>> Stated("1.3e-2", False, 0, 6).rewritten(4.44e-5, up=False)
        '4.4e-5'
        >>> Stated(".4", True, 0, 2).rewritten(0.00511, up=True)
        '.6'
        """
        number = Decimal(value / self.unit)
        scientific = "e" in self.text
        last = (number.adjusted() if scientific else 0) - self.decimals
        number = number.quantize(Decimal(1).scaleb(last), ROUND_CEILING if up else ROUND_HALF_EVEN)
        if scientific:
            return re.sub(r"e([-+])0*", r"e\1", f"{number:.{self.decimals}e}").replace("e+", "e")
        text = f"{number:,.{self.decimals}f}" if "," in self.text else f"{number:.{self.decimals}f}"
        return re.sub(r"^(-?)0\.", r"\1.", text) if re.match(r"-?\.", self.text) else text


def numbers(text: str, name: str, count: int) -> Iterator[list[Stated]]:
    """Yield the first `count` numbers behind every mark of this name.

    Raises
    ------
    ValueError
        If fewer numbers follow a mark, or the first does not follow at once.
    """
    for mark in MARK.finditer(text):
        if mark[1] == name:
            end = following.start() if (following := MARK.search(text, mark.end())) else len(text)
            found = [
                Stated(n[1], bool(n[2]), n.start(1), n.end(1)) for n in NUMBER.finditer(text, mark.end(), end)
            ]
            if len(found) < count or found[0].start != mark.end():
                raise ValueError(f"mark {name}: needs {count} numbers right behind it")
            yield found[:count]


def claim(
    name: str, page: str, stated: list[Stated], values: tuple[float, ...], bound: bool, relative: float | None
) -> Claim:
    """Return the claim that the values are the stated numbers, or bounded by them."""
    if bound:
        quantities = [
            Quantity(name=f"<= {one.text}", exact=0.0, scale=ROUND_OFF * abs(one.value)) for one in stated
        ]
        why = "the stated bound of round-off"
    elif relative is not None:
        quantities = [
            Quantity(name=one.text, exact=one.value, scale=relative * abs(one.value)) for one in stated
        ]
        why = "what differs from processor to processor"
    else:
        quantities = [Quantity(name=one.text, exact=one.value, scale=one.half_unit) for one in stated]
        why = "half a unit of the last digit stated"
    return Claim(
        name=name, statement=f"{name} of {page}", source=page, quantities=tuple(quantities),
        allowance=Allowance(error=1.0, why=why), measure=lambda: values,
    )  # fmt: skip


def check(
    name: str, *values: float, bound: bool = False, relative: float | None = None, write: bool = False
) -> None:
    """Judge measured values against what every page states under a name, or write what does not hold.

    Parameters
    ----------
    name : str
        Of the marks.
    *values : float
        As many as the numbers behind each mark.
    bound : bool
        The numbers are bounds, which the values exceed by no more than the factor `ROUND_OFF`.
    relative : float, optional
        Part of a number by which the value may differ. Otherwise it may by half a unit of the last digit stated.
    write : bool
        Whether numbers that do not hold are replaced in the pages.
    """
    measured, places = tuple(map(float, values)), 0
    with alone_in(ROOT / "docs"):
        for path in pages():
            text = path.read_text(encoding="utf-8")
            stated = list(numbers(text, name, len(measured)))
            places += len(stated)
            judged = [judge(claim(name, path.name, one, measured, bound, relative)) for one in stated]
            failures = [f"{path.name}: {name}: {one.failure}" for one in judged if not one.passed]
            if failures and write:
                for one in reversed(stated):
                    text = replaced(text, one, measured, up=bound)
                write_text(path, text)
            else:
                assert not failures, failures
    assert places, f"{name}: no page has this mark"


def replaced(text: str, stated: list[Stated], values: tuple[float, ...], *, up: bool) -> str:
    """Return the text with other values of stated numbers."""
    for one, value in reversed(list(zip(stated, values, strict=True))):
        text = text[: one.start] + one.rewritten(value, up=up) + text[one.end :]
    return text
