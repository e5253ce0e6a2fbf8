"""The root finder of events: smooth functions, jumps, functions without a value."""

from __future__ import annotations

import math

import pytest

from tsm.root import find_root

SMOOTH = {
    "line": (lambda t: 0.3 - t, 0.3),
    "rising": (lambda t: t**3 - 0.2, 0.2 ** (1 / 3)),
    "flat at one end": (lambda t: math.exp(-5 * t) - math.exp(-4.5), 0.9),
    "tenfold root": (lambda t: (0.37 - t) ** 9, 0.37),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_a_root_is_found_well_within_the_bound_of_evaluations(name):
    function, root = SMOOTH[name]
    asked = []

    def evaluate(t):
        asked.append(t)
        return function(t), t

    found = find_root(evaluate, (0.0, function(0.0)), (1.0, function(1.0)), small=1e-13, apart=1e-14)
    assert found == pytest.approx(root, abs=0.05 if name == "tenfold root" else 1e-11)
    assert abs(function(found)) <= 1e-13
    assert found == asked[-1]
    assert len(asked) <= 50


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_behind_a_jump_the_last_sample_is_past_it(sign):
    jump = 0.7310585
    found = find_root(
        lambda t: (sign * (2.0 if t < jump else -1.0), t),
        (0.0, 2.0 * sign),
        (1.0, -sign),
        small=1e-12,
        apart=1e-13,
    )
    assert 0 <= found - jump < 1e-13


def test_behind_a_high_jump_the_answer_is_past_it():
    """False position comes to this jump from the side of the larger value last."""
    jump = 0.39999999979993894
    values = {0.25: 1.0, 0.5: -0.05}

    def evaluate(t):
        return 1.0 if t < jump else -0.3 * (t - 1 / 3), t

    found = find_root(evaluate, *values.items(), small=1e-12, apart=1e-14)
    assert evaluate(found)[0] < 0
    assert 0 <= found - jump < 1e-13


def test_no_value_ends_the_search():
    asked = []

    def evaluate(t):
        asked.append(t)
        return None if len(asked) == 3 else (0.5 - t + 0.1 * t**2, t)

    assert find_root(evaluate, (0.0, 0.5), (1.0, -0.4), small=1e-15, apart=1e-15) is None
    assert len(asked) == 3
