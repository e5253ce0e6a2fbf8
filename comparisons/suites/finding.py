"""An error with its bound, and checks as JUnit XML, which CI servers read."""

import math
from collections.abc import Iterable

from comparisons.frozen import Value

JUNIT = """\
<?xml version="1.0" encoding="utf-8"?>
<testsuite name="{{ suite }}" tests="{{ checks | length }}" failures="{{ checks | map(attribute=3) | reject("none") | list | length }}" \
errors="0" skipped="0" time="{{ "%f" % (checks | sum(2)) }}">
{% for group, name, seconds, failure, output in checks %}
  <testcase classname="{{ group }}" name="{{ name }}" time="{{ "%f" % seconds }}">
{% if failure is not none %}
    <failure message="{{ failure }}" />
{% endif %}
{% if output %}
    <system-out>{{ output }}</system-out>
{% endif %}
  </testcase>
{% endfor %}
</testsuite>"""


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
    def failure(self) -> str:
        """The sentence for a bound that is broken."""
        value = self.error if self.value is None else self.value
        return (
            f"{self.name}: {value:.10g}, exact {self.exact:.10g}, error {self.error:.2g} > {self.allowed:.2g}"
        )

    @property
    def measured(self) -> str:
        """The error and its bound in one line."""
        return f"{self.name}: error {self.error:.2g}, allowed {self.allowed:g}"


def junit_text(suite: str, checks: Iterable[tuple[str, str, float, str | None, str]]) -> str:
    """Return checks as the JUnit XML of one test suite.

    A check has its group, its name, its seconds, why it failed if it did, in one line with numbers, and what was measured.

    Examples
    --------
    >>> print(junit_text("manual", [("euler", "rod", 0.0, "off by 2", "")]))
    <?xml version="1.0" encoding="utf-8"?>
    <testsuite name="manual" tests="1" failures="1" errors="0" skipped="0" time="0.000000">
      <testcase classname="euler" name="rod" time="0.000000">
        <failure message="off by 2" />
      </testcase>
    </testsuite>
    <BLANKLINE>
    """
    from jinja2 import Template

    template = Template(JUNIT, autoescape=True, trim_blocks=True)
    return f"{template.render(suite=suite, checks=list(checks))}\n"
