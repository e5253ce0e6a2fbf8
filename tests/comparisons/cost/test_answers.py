"""Limits by extrapolation, and how far one answer is from another."""

from dataclasses import fields, replace

import numpy as np
import pytest

from comparisons.cost.answers import DEPENDENT, Answer, end_state, errors, extrapolated, scales, uncertainty
from comparisons.scene import load_scene

KS = load_scene("ks-cantilever")
TIMES = np.array([0.2, 0.4, 0.6, 0.8, 1.0])


def answer_of(h: float, order: float = 2.0) -> Answer:
    """An answer that converges with the order, the contact open at first."""
    s = np.arange(1.0, 6.0)
    off = h**order
    return Answer(
        load_parameter=TIMES,
        force=(s * (1.0 + off))[:, None],
        arc_position=np.where(s < 2.0, np.nan, 0.5 + off * s)[:, None],
        clamp_moment=-2.0 * (s + off)[:, None],
        tip=np.stack([s, 1.0 - off * s], axis=-1)[:, None],
        shape_at=TIMES[[1, 4]],
        shape=np.ones((2, 1, 101, 2)) * (1.0 + off * np.linspace(0, 1, 101))[:, None],
    )


@pytest.mark.parametrize("order", [1.0, 2.0, 3.5])
def test_limit_of_a_series_of_any_order(order: float) -> None:
    found, doubt = extrapolated([answer_of(h, order) for h in (0.2, 0.1, 0.05)])
    exact = answer_of(0.0)
    for item in fields(Answer):
        limit = getattr(exact, item.name)
        assert getattr(found, item.name) == pytest.approx(limit, abs=1e-12, nan_ok=True)
    last = answer_of(0.1, order).force - answer_of(0.05, order).force
    assert doubt.force == pytest.approx(last, rel=1e-10)


def test_nothing_is_added_to_a_series_that_does_not_converge() -> None:
    found, doubt = extrapolated([answer_of(h) for h in (0.05, 0.06, 0.1)])
    assert np.array_equal(found.force, answer_of(0.1).force)
    assert doubt.force == pytest.approx(answer_of(0.1).force - answer_of(0.06).force)


def test_errors_are_relative_to_the_reference_and_the_length() -> None:
    reference, found = answer_of(0.0), answer_of(0.1)
    scale = scales(reference, KS)
    assert (scale.force, scale.moment, scale.length) == (5.0, 10.0, 1.0)
    table = errors(found, reference, scale, end_state(reference))
    assert table["path"] == pytest.approx(
        {
            "force": 0.01,
            "arc_position": 0.05,
            "clamp_moment": 0.002,
            "tip": 0.05,
            "shape_largest": 0.01 * np.sqrt(2.0),
            "shape_mean": 0.005 * np.sqrt(2.0),
        }
    )
    assert table["end"] == pytest.approx(table["path"])


def test_errors_at_shared_load_parameters_only() -> None:
    reference, whole = answer_of(0.0), answer_of(0.1)
    first_two = {name: getattr(whole, name)[:2] for name in DEPENDENT if name != "shape"}
    few = replace(whole, load_parameter=TIMES[:2] + np.array([0.0, 0.01]), **first_two)
    table = errors(few, reference, scales(reference, KS), 1.0)
    assert table["path"]["force"] == pytest.approx(0.01 / 5.0)
    assert np.isnan(table["path"]["arc_position"])
    assert np.isnan(table["end"]["force"])


def test_end_state_is_the_last_with_a_force() -> None:
    reference = answer_of(0.0)
    force = reference.force.copy()
    force[3:] = 0.0
    assert end_state(replace(reference, force=force)) == 0.6
    assert end_state(replace(reference, force=0.0 * force)) == 1.0


def test_uncertainty_is_stated_as_errors_are() -> None:
    answers = [answer_of(h) for h in (0.2, 0.1, 0.05)]
    found, doubt = extrapolated(answers)
    scale = scales(found, KS)
    known = uncertainty(doubt, scale, 1.0)
    apart = errors(answers[1], answers[2], scale, 1.0)
    assert known["path"] == pytest.approx(apart["path"])
