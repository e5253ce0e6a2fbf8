"""What the benchmark writes can be read, whatever the numbers were measured with."""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np

_spec = importlib.util.spec_from_file_location("bench", Path(__file__).with_name("bench.py"))
bench = importlib.util.module_from_spec(_spec)
sys.modules["bench"] = bench
_spec.loader.exec_module(bench)


def test_measured_ratios_are_written_and_read():
    gates = [bench.Gate("ratio", np.float64(3.5), 3.0, True), bench.Gate("cut-backs", np.int64(1), 0, False)]
    record = json.loads(bench.recorded(gates, {"import tsm": 0.25}))
    assert [(gate["name"], gate["value"], gate["met"]) for gate in record["gates"]] == [
        ("ratio", 3.5, True),
        ("cut-backs", 1.0, False),
    ]
    assert record["seconds"] == {"import tsm": 0.25}
