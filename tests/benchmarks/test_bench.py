"""What the benchmark writes can be read, whatever the numbers were measured with."""

import json

import numpy as np

from tests.benchmarks import bench
from tests.benchmarks.measure import Gate


def test_measured_ratios_are_written_and_read():
    gates = [Gate("ratio", np.float64(3.5), 3.0, True), Gate("cut-backs", np.int64(1), 0, False)]
    record = json.loads(bench.recorded(gates, {"import tsm": 0.25}))
    assert [(gate["name"], gate["value"], gate["met"]) for gate in record["gates"]] == [
        ("ratio", 3.5, True),
        ("cut-backs", 1.0, False),
    ]
    assert record["seconds"] == {"import tsm": 0.25}
