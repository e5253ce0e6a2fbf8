"""An error with its bound, and checks as JUnit XML, which CI servers read."""

import math
from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from comparisons.frozen import Value


class Finding(Value):
    """An error with its bound and the reason of the bound; the error is infinite where there is no answer.

    What is compared as a number has its value and the exact one.
    """

    name: str
    error: float
    allowed: float
    why: str = "asked for"
    value: float | None = None
    exact: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether the error is within what is allowed; nan is not."""
        return self.error <= self.allowed

    @property
    def share(self) -> float:
        """The error over the allowed error, infinite if the error is nan."""
        share = self.error / self.allowed
        return share if math.isfinite(share) else math.inf

    @property
    def failure(self) -> str | None:
        """The sentence for a bound that is broken; None for one that holds."""
        value = self.error if self.value is None else self.value
        said = (
            f"{self.name}: {value:.10g}, exact {self.exact:.10g}, error {self.error:.2g} > {self.allowed:.2g}"
        )
        return None if self.holds else said

    @property
    def measured(self) -> str:
        """The error and its bound in one line."""
        return f"{self.name}: error {self.error:.2g}, allowed {self.allowed:g}"


def junit_text(suite: str, checks: Iterable[tuple[str, str, float, str | None, Iterable[Finding]]]) -> str:
    """Return checks as the JUnit XML of one test suite.

    A check has its group, its name, its seconds, why it failed if it did, in one line with numbers, and what was found.

    Examples
    --------
    >>> found = [Finding(name="tip", error=2.0, allowed=1e-3)]
    >>> print(junit_text("manual", [("euler", "rod", 0.0, "off by 2", found)]))
    <?xml version="1.0" encoding="utf-8"?>
    <testsuite name="manual" tests="1" failures="1" errors="0" skipped="0" time="0.000000">
      <testcase classname="euler" name="rod" time="0.000000">
        <failure message="off by 2" />
        <system-out>tip: error 2, allowed 0.001</system-out>
      </testcase>
    </testsuite>
    <BLANKLINE>
    """
    listed = list(checks)
    failed, seconds = sum(one[3] is not None for one in listed), sum(one[2] for one in listed)
    count = {"tests": str(len(listed)), "failures": str(failed), "errors": "0", "skipped": "0"}
    root = Element("testsuite", {"name": suite, **count, "time": f"{seconds:f}"})
    for group, name, spent, failure, findings in listed:
        case = SubElement(root, "testcase", classname=group, name=name, time=f"{spent:f}")
        if failure is not None:
            SubElement(case, "failure", message=failure)
        SubElement(case, "system-out").text = "\n".join(one.measured for one in findings)
    indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{tostring(root, encoding="unicode")}\n'
