"""Speed as ratios within one run, one thread. `make bench` writes them to bench.json; the ratios gate, times inform."""

from __future__ import annotations

import argparse
import json
import platform
from pathlib import Path

from comparisons.files import write_text
from tests.benchmarks import beams, solid, start
from tests.benchmarks.measure import Gate


def recorded(gates: list[Gate], times: dict[str, float]) -> str:
    """What was measured, and where, as JSON."""
    record = {
        "machine": platform.platform(),
        "python": platform.python_version(),
        "gates": [vars(gate) | {"value": float(gate.value), "met": gate.met} for gate in gates],
        "seconds": times,
    }
    return json.dumps(record, indent=1) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("bench.json"))
    out = parser.parse_args().out
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
        beams.batches,
        solid.assembly,
        solid.memory,
        start.start_up,
    ):
        part(gates, times)
    for gate in gates:
        print(gate)
    for name, value in times.items():
        print(f"         {name}: {1e3 * value:.3g} ms")
    write_text(out, recorded(gates, times))


if __name__ == "__main__":
    main()
