"""Newton's method from start states that no step would offer: it returns a status, and what it calls converged is in equilibrium."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import tsm
from tsm.contact_set import changed, initial_state
from tsm.model import Model
from tsm.newton import Newton
from tsm.settings import Settings
from tsm.state import Profile, State, Touch
from tsm.status import Status

SECTION = tsm.Section(EA=1e4, GA=4e3, EI=1.0)
ENDS = {
    Status.CONVERGED, Status.ITERATION_LIMIT, Status.NOT_FINITE, Status.SINGULAR_TANGENT, Status.INACCURATE,
    Status.PING_PONG, Status.TWO_CONTACTS,
}  # fmt: skip
RANDOM = settings(deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck))
magnitudes = st.one_of(st.floats(-9, 1), st.floats(-300, 300)).map(lambda exponent: 10.0**exponent)
parts = st.one_of(st.floats(0, 1), st.sampled_from([0.0, 1.0, 0.5, -0.2, 1.3, 1e6, math.nan]))


def structure(element: str, elements: int) -> tsm.Structure:
    """A cantilever under a pin whose tip touches a second one."""
    beams = [
        tsm.Beam(name=name, start=(0.0, y), end=(1.0, y), section=SECTION, elements=elements, element=element)
        for name, y in (("upper", 0.0), ("lower", -0.1))
    ]
    return tsm.Structure(
        beams=tuple(beams),
        supports=tuple(tsm.Support(beam=beam.name, end="start") for beam in beams),
        pins=(tsm.Pin(name="pin", path=((0.83, 0.0), (0.7, -0.4))),),
        contacts=(
            tsm.ContactPair(node="pin", beam="upper", side="left"),
            tsm.ContactPair(node="upper.end", beam="lower", side="left"),
        ),
    )


@st.composite
def starts(draw: st.DrawFn, model: Model) -> State:
    """A state with random displacements, contacts, contact forces and angles inside."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    state = initial_state(model)
    q = state.q.copy()
    q[model.free] += draw(magnitudes) * random.standard_normal(len(model.free))
    state = replace(state, load_parameter=draw(st.floats(0, 1)), q=q)
    for k, pair in enumerate(model.pairs):
        touch = None
        if draw(st.booleans()):
            first, last = pair.target.first, pair.target.last
            force = draw(magnitudes) * random.standard_normal(2)
            touch = Touch(
                element=draw(st.integers(first, last)),
                xi=draw(parts),
                force=(float(force[0]), float(force[1])),
                angle=float(draw(magnitudes) * random.standard_normal()),
            )
        with np.errstate(all="ignore"):
            state = changed(model, state, k, touch, armed=draw(st.booleans()))
    if state.profile is not None:
        angle = state.profile.angle + draw(magnitudes) * random.standard_normal(state.profile.angle.shape)
        state = replace(state, profile=Profile(cuts=state.profile.cuts, angle=angle))
    return state


def check(element: str, examples: int) -> dict[Status, int]:
    """Count the statuses of Newton's method from `examples` starts."""
    models = [Model(structure(element, n)) for n in (1, 4)]
    counts = dict.fromkeys(ENDS, 0)

    @settings(RANDOM, max_examples=examples)
    @given(st.sampled_from(models).flatmap(lambda model: st.tuples(st.just(model), starts(model))))
    def run(drawn: tuple[Model, State]) -> None:
        model, start = drawn
        kept = start.q.copy()
        with np.errstate(all="ignore"):
            found = Newton(model, Settings()).solve(start)
            assert found.status in ENDS
            assert np.array_equal(start.q, kept, equal_nan=True)
            counts[found.status] += 1
            if found.status is Status.CONVERGED:
                afresh = Newton(model, Settings())
                system = afresh.assembler.linearise(found.state)
                assert afresh.norm(system) <= max(
                    afresh.tolerance, afresh.noise, min(system.noise / model.force_scale, 1e-6)
                )
                assert np.isfinite(found.state.q).all()

    run()
    return counts


@pytest.mark.slow_at(
    "euler-bernoulli-cantilever",
    "euler-bernoulli-cantilever-as-printed",
    "euler-bernoulli-simple",
    "euler-bernoulli-simple-as-printed",
    "exact",
    "timoshenko",
    "timoshenko-as-printed",
)
@pytest.mark.parametrize("element", tsm.ELEMENTS)
def test_newton_from_random_starts(element: str) -> None:
    counts = check(element, 40)
    assert counts[Status.CONVERGED] > 0
    assert sum(counts.values()) > counts[Status.CONVERGED]


@pytest.mark.slow
@pytest.mark.parametrize("element", tsm.ELEMENTS)
def test_newton_from_many_random_starts(element: str) -> None:
    assert check(element, 400)[Status.CONVERGED] > 0
