"""Limits by extrapolation, and errors by the one measure."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.cost.limit import end_state, extrapolated
from comparisons.errors import error_histories, errors, scales
from comparisons.response import ContactHistory, Response, SupportHistory
from comparisons.response.axis import STATIONS, SampledAxes
from comparisons.response.record import unanswered
from comparisons.scene import load_scene

KS = load_scene("ks-cantilever")
PAIR, BEAM = "pin->cantilever", "cantilever"
CLAMP, TIP = "cantilever.start", "cantilever.end"
TIMES = np.array([0.2, 0.4, 0.6, 0.8, 1.0])


def response_of(h: float, order: float = 2.0) -> Response:
    """A response that converges with the order, the contact open at first."""
    s = np.arange(1.0, 6.0)
    off = h**order
    arc = np.where(s < 2.0, np.nan, 0.5 + off * s)
    axis = np.ones((5, 101, 2)) * (1.0 + off * STATIONS)[:, None]
    return replace(
        unanswered("COMPLETED", ""),
        load_parameter=TIMES,
        contacts={PAIR: ContactHistory(force=s * (1.0 + off), arc_position=arc, gap=0.0 * s)},
        supports={CLAMP: SupportHistory(force=np.zeros((5, 2)), moment=-2.0 * (s + off))},
        material_force={BEAM: off * s},
        tips={BEAM: np.stack([s, 1.0 - off * s], axis=-1)},
        axis_line=SampledAxes(arc_length={BEAM: STATIONS}, position={BEAM: axis}),
    )


@pytest.mark.parametrize("order", [1.0, 2.0, 3.5])
def test_limit_of_a_series_of_any_order(order: float) -> None:
    found, exact = extrapolated([response_of(h, order) for h in (0.2, 0.1, 0.05)]), response_of(0.0)
    contact, limit = found.contacts[PAIR], exact.contacts[PAIR]
    assert contact.force == pytest.approx(limit.force, abs=1e-12)
    assert contact.arc_position == pytest.approx(limit.arc_position, abs=1e-12, nan_ok=True)
    assert found.supports[CLAMP].moment == pytest.approx(exact.supports[CLAMP].moment, abs=1e-12)
    assert found.material_force[BEAM] == pytest.approx(exact.material_force[BEAM], abs=1e-12)
    assert found.tips[BEAM] == pytest.approx(exact.tips[BEAM], abs=1e-12)
    for k in range(5):
        assert found.axis_line(BEAM, k)[1] == pytest.approx(exact.axis_line(BEAM, k)[1], abs=1e-12)


def test_forces_of_supports_have_a_limit_where_there_is_no_contact() -> None:
    def held(h: float) -> Response:
        force = np.arange(10.0).reshape(5, 2) + h**2
        other = SupportHistory(force=-force, moment=np.zeros(5))
        support = SupportHistory(force=force, moment=force[:, 0])
        return replace(response_of(h), contacts={}, supports={CLAMP: support, TIP: other})

    found, exact = extrapolated([held(h) for h in (0.2, 0.1, 0.05)]), held(0.0).supports[CLAMP]
    assert found.supports[CLAMP].force == pytest.approx(exact.force, abs=1e-12)
    assert found.supports[TIP].force == pytest.approx(-exact.force, abs=1e-12)
    assert errors(held(0.1), held(0.0), load_scene("ks-tied-tip"))["path"]["force"] == pytest.approx(
        0.01 * np.sqrt(2) / np.hypot(8, 9)
    )


def test_nothing_is_added_to_a_series_that_does_not_converge() -> None:
    found = extrapolated([response_of(h) for h in (0.05, 0.06, 0.1)])
    assert np.array_equal(found.contacts[PAIR].force, response_of(0.1).contacts[PAIR].force)


def test_errors_are_relative_to_the_reference_and_the_length() -> None:
    reference, found = response_of(0.0), response_of(0.1)
    scale = scales(reference)
    assert (scale.force, scale.moment) == (5.0, 10.0)
    table = errors(found, reference, KS, end=end_state(reference))
    assert table["path"] == pytest.approx(
        {
            "force": 0.01,
            "arc": 0.05,
            "friction": 0.01 / 1.01,
            "moment": 0.002,
            "tip": 0.05,
            "shape": 0.01 * np.sqrt(2.0),
            "shape_mean": 0.005 * np.sqrt(2.0),
        }
    )
    assert table["end"] == pytest.approx(table["path"])


def test_errors_at_shared_load_parameters_only() -> None:
    reference, whole = response_of(0.0), response_of(0.1)
    few = replace(whole, load_parameter=TIMES[:2] + np.array([0.0, 0.01]))
    shared, found = error_histories(few, reference, KS)
    assert shared.tolist() == [0.2]
    assert found["force"] == pytest.approx(0.01 / 5.0)
    assert np.isnan(found["arc"])
    table = errors(few, reference, KS)
    assert np.isnan([*table["path"].values(), *table["end"].values()]).all()


def test_what_is_no_number_or_open_in_one_alone_has_an_infinite_error() -> None:
    reference = response_of(0.0)
    contact = replace(reference.contacts[PAIR], force=np.full(5, np.nan), arc_position=np.full(5, 0.5))
    _, found = error_histories(replace(reference, contacts={PAIR: contact}), reference, KS)
    assert np.isinf(found["force"]).all()
    assert np.isinf(found["arc"]).tolist() == [True, False, False, False, False]


def test_end_state_is_the_last_with_a_force() -> None:
    reference = response_of(0.0)
    contact = reference.contacts[PAIR]
    left = replace(contact, force=np.where(TIMES > 0.7, 0.0, contact.force))
    assert end_state(replace(reference, contacts={PAIR: left})) == 0.6
    assert end_state(replace(reference, contacts={PAIR: replace(contact, force=np.zeros(5))})) == 1.0
