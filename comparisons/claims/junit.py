"""JUnit XML: what a CI server reads of checks."""

from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement, indent, tostring


@dataclass(frozen=True, kw_only=True)
class JUnitCase:
    """One check: its group and name, seconds, why it failed if it did, in one line with numbers, and what was measured."""

    classname: str
    name: str
    seconds: float = 0.0
    failure: str | None = None
    output: str = ""


def junit_text(suite: str, cases: Iterable[JUnitCase]) -> str:
    """Return checks as the JUnit XML of one test suite.

    Examples
    --------
    >>> print(junit_text("manual", [JUnitCase(classname="euler", name="rod", failure="off by 2")]))
    <?xml version="1.0" encoding="utf-8"?>
    <testsuite name="manual" tests="1" failures="1" errors="0" skipped="0" time="0.000000">
      <testcase classname="euler" name="rod" time="0.000000">
        <failure message="off by 2" />
      </testcase>
    </testsuite>
    <BLANKLINE>
    """
    listed = list(cases)
    root = Element(
        "testsuite",
        name=suite,
        tests=str(len(listed)),
        failures=str(sum(case.failure is not None for case in listed)),
        errors="0",
        skipped="0",
        time=f"{sum(case.seconds for case in listed):.6f}",
    )
    for case in listed:
        names = {"classname": case.classname, "name": case.name, "time": f"{case.seconds:.6f}"}
        element = SubElement(root, "testcase", names)
        if case.failure is not None:
            SubElement(element, "failure", message=case.failure)
        if case.output:
            SubElement(element, "system-out").text = case.output
    indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + tostring(root, encoding="unicode") + "\n"
