"""Nested numbers as text."""

import json
from dataclasses import dataclass

import numpy as np

from comparisons.output import json_text


@dataclass
class Record:
    name: str
    values: np.ndarray


def test_numbers_come_back_and_what_is_not_finite_is_null() -> None:
    values = np.array([[[0.1, 1e-300], [np.nan, -np.inf]], [[2.0, 3.0], [4.0, 5.0]]])
    text = json_text(
        {
            "record": Record("a", values),
            "whole": (np.arange(3), np.array([True, False]), np.zeros((0, 2)), np.array(["text"])),
            "tables": [{"x": np.float64("nan"), "y": {}}, {"x": 1, "rows": [[1.5], [None, {"z": "</a>"}]]}],
        }
    )
    assert json.loads(text) == {
        "record": {"name": "a", "values": [[[0.1, 1e-300], [None, None]], [[2.0, 3.0], [4.0, 5.0]]]},
        "whole": [[0, 1, 2], [True, False], [], ["text"]],
        "tables": [{"x": None, "y": {}}, {"x": 1, "rows": [[1.5], [None, {"z": "</a>"}]]}],
    }
    assert ' "values": [\n   [[0.1, 1e-300], [null, null]],\n' in text
