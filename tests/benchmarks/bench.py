"""Speed as ratios within one run, one thread. `make bench` writes them to bench.json and compares them with the pages."""

from __future__ import annotations

import argparse
import json
import platform
import sys
from pathlib import Path

from comparisons.files import write_text
from tests.benchmarks import beams, comparison, solid, start
from tests.benchmarks.measure import Gate
from tests.stated import MARK, check, pages

VARIES = 0.25
"""Part of a stated ratio by which machines and runs may differ."""


def recorded(gates: list[Gate], times: dict[str, float]) -> str:
    """What was measured, and where, as JSON."""
    record = {
        "machine": platform.platform(),
        "python": platform.python_version(),
        "gates": [vars(gate) | {"value": float(gate.value), "met": gate.met} for gate in gates],
        "seconds": times,
    }
    return json.dumps(record, indent=1) + "\n"


def compared(gates: list[Gate], *, write: bool) -> list[str]:
    """Return a line for every ratio that is not what the pages state."""
    marks = {mark for page in pages() for mark in MARK.findall(page.read_text())}
    failures = []
    for gate in gates:
        if gate.mark in marks:
            try:
                check(gate.mark, gate.value, relative=VARIES, write=write)
            except AssertionError as error:
                failures.append(str(error))
    return failures


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("bench.json"))
    parser.add_argument("--write-results", action="store_true", help="write changed ratios into the pages")
    given = parser.parse_args()
    gates: list[Gate] = []
    times: dict[str, float] = {}
    for part in (
        beams.beams_against_solid,
        beams.equal_error,
        beams.scenes_and_elements,
        beams.linear_cost,
        solid.index_and_certificate,
        beams.many_beams,
        beams.exact_element,
        solid.solution,
        solid.assembly,
        solid.memory,
        comparison.comparison,
        start.start_up,
    ):
        part(gates, times)
    for gate in gates:
        print(gate)
    for name, value in times.items():
        print(f"         {name}: {1e3 * value:.3g} ms")
    write_text(given.out, recorded(gates, times))
    failures = compared(gates, write=given.write_results)
    marks = {mark for page in pages() for mark in MARK.findall(page.read_text()) if mark.startswith("bench.")}
    failures += [f"{mark}: nothing measures it" for mark in sorted(marks - {gate.mark for gate in gates})]
    print(*failures, sep="\n")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
