"""Numbers that the pages state, each behind a mark with its name: ``<!--name-->1.5e-5``. `pytest --write-results` writes them anew.

A mark names the number behind it, ``<!--name x3-->`` the first three, before the next mark; a name may stand on several pages. A test
measures the numbers of a name and judges them on every page, at the digits stated there.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Decimal
from pathlib import Path
from tempfile import gettempdir

from filelock import FileLock

ROOT = Path(__file__).parents[1]
MARK = re.compile(r"<!--([a-z][\w.-]*)(?: x\d+)?-->")
NUMBER = re.compile(r"(?<![\w.`-])(-?(?:\d{1,3}(?:,\d{3})+|\d*\.?\d+(?:e-?\d+)?))(?![\w`])( %)?")

EPS = sys.float_info.epsilon
LOOSE, LOOSE_ROUND_OFF, ROUND_OFF = 3.0, 30.0, 1e-10
"""Largest factors of a stated bound over what is measured: of an error, and of one below the third number, which is round-off and differs
between processors."""
MEASURED: dict[str, tuple[bool, list[float]]] = {}
"""Whether a name states bounds, and the largest values that were measured."""


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
    def value(self) -> float:
        return float(self.text.replace(",", "")) * (0.01 if self.percent else 1.0)

    @property
    def decimals(self) -> int:
        return len(self.text.partition("e")[0].partition(".")[2])

    @property
    def half_unit(self) -> float:
        """Half a unit of the last digit."""
        exponent = int(self.text.partition("e")[2] or 0) - self.decimals - 2 * self.percent
        return 0.5 * 10.0**exponent

    def rewritten(self, value: float, *, up: bool) -> str:
        """Return a value with as many digits and in the same form, rounded up if it is a bound.

        >>> Stated("1.3e-2", False, 0, 6).rewritten(4.44e-5, up=False)
        '4.4e-5'
        >>> Stated(".4", True, 0, 2).rewritten(0.00511, up=True)
        '.6'
        """
        number = Decimal(100.0 * value if self.percent else value)
        scientific = "e" in self.text
        last = (number.adjusted() if scientific else 0) - self.decimals
        number = number.quantize(Decimal(1).scaleb(last), ROUND_CEILING if up else ROUND_HALF_EVEN)
        if scientific:
            return re.sub(r"e([-+])0*", r"e\1", f"{number:.{self.decimals}e}").replace("e+", "e")
        text = f"{number:,.{self.decimals}f}" if "," in self.text else f"{number:.{self.decimals}f}"
        return re.sub(r"^(-?)0\.", r"\1.", text) if re.match(r"-?\.", self.text) else text


def count(mark: re.Match[str]) -> int:
    """Return how many numbers a mark names."""
    return int([*mark[0][:-3].split(" x"), "1"][1])


def marked(text: str, mark: re.Match[str]) -> list[Stated]:
    """Return the numbers that a mark names.

    Raises ValueError if fewer numbers follow the mark, or the first does not follow at once.
    """
    end = following.start() if (following := MARK.search(text, mark.end())) else len(text)
    found = [Stated(n[1], bool(n[2]), n.start(1), n.end(1)) for n in NUMBER.finditer(text, mark.end(), end)]
    if len(found) < count(mark) or found[0].start != mark.end():
        raise ValueError(f"mark {mark[1]}: needs {count(mark)} numbers right behind it")
    return found[: count(mark)]


def holds(one: Stated, value: float, least: float | None = None, relative: float | None = None) -> bool:
    """Whether a value is the stated number, to half a unit of its last digit or a part of it; or at most it, and at least a part of it."""
    if least is not None:
        return least * abs(one.value) * (1.0 - 1e-9) <= abs(value) <= abs(one.value) * (1.0 + 1e-9)
    return abs(value - one.value) <= (one.half_unit if relative is None else relative * abs(one.value))


def check(
    name: str,
    *values: float,
    bound: bool = False,
    part: bool = False,
    relative: float | None = None,
    write: bool = False,
) -> None:
    """Judge measured values against what every page states under a name, or write what does not hold.

    The numbers of a `bound` are not below the values, and at most `loose` times these; of `part` they are bounds of several measurements,
    of which this is one: the largest is judged by `left` at the end of a whole run. By `relative`, a part of the number, a value may
    differ, otherwise by half a unit of the last digit stated. With `write`, numbers that do not hold are replaced in the pages.
    """
    measured, places = tuple(map(float, values)), 0
    record(name, bound or part, measured)
    if bound or part:
        # no arithmetic is better than its last bit
        measured = tuple(max(abs(value), 0.0 if part else EPS) for value in measured)
    up = part or bound
    with FileLock(Path(gettempdir(), "crossval-pages.lock")):
        for path in pages():
            text = path.read_text(encoding="utf-8")
            for mark in reversed([mark for mark in MARK.finditer(text) if mark[1] == name]):
                stated, places = marked(text, mark), places + 1
                pairs = zip(stated, measured, strict=True)
                wrong = [
                    f"{value:.6g} for {one.text}"
                    for one, value in pairs
                    if not holds(one, value, (0.0 if part else 1.0 / loose(value)) if up else None, relative)
                ]
                assert write or not wrong, f"{path.name}: {name}: {', '.join(wrong)}"
                if wrong:
                    shown = [value * loose(value) ** 0.5 if up else value for value in measured]
                    text = replaced(text, stated, shown, up=up)
                    path.write_text(text, encoding="utf-8")
    assert places, f"{name}: no page has this mark"


def loose(value: float) -> float:
    """Return the largest factor of a stated bound over a value."""
    return LOOSE if value > ROUND_OFF else LOOSE_ROUND_OFF


def record(name: str, bound: bool, values: Sequence[float]) -> None:
    """Keep the largest values of a name."""
    before = MEASURED.get(name, (bound, values))[1]
    MEASURED[name] = bound, [max(abs(pair[0]), abs(pair[1])) for pair in zip(values, before, strict=True)]


def left(*, write: bool) -> Iterator[str]:
    """Yield the names whose bounds are loose for the largest value of a whole run, and those that no test of it has measured."""
    for name, (bound, values) in list(MEASURED.items()):
        if bound:
            try:
                check(name, *values, bound=True, write=write)
            except AssertionError as error:
                yield str(error)
    marks = {mark for page in pages() for mark in MARK.findall(page.read_text())}
    yield from (
        f"{name}: no test has measured it"
        for name in sorted(marks - MEASURED.keys())
        if not name.startswith("bench.")
    )


def replaced(text: str, stated: list[Stated], values: Sequence[float], *, up: bool) -> str:
    """Return the text with other values of stated numbers."""
    for one, value in reversed(list(zip(stated, values, strict=True))):
        text = text[: one.start] + one.rewritten(value, up=up) + text[one.end :]
    return text
