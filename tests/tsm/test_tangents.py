"""Tangents of whole structures are the derivatives of their residuals, and lead Newton's method to the square of its error."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import KS, KS_PATH, as_mixed, cantilever, hook, leaning, pushed

# a residual and its tangent at a state that is no equilibrium are nowhere public
from tsm.model.model import Model
from tsm.system.newton import Newton


def moving_end(element):
    """A cantilever that the end of another beam presses down, which a support moves."""
    plain = cantilever(element=element, elements=2)
    other = replace(plain.beams[0], name="up", start=(0.8, 0.5), end=(0.8, 0.0))
    ends = (tsm.Support(beam="up", end=end, uy=-0.1, rotation=0.0) for end in ("start", "end"))
    contact = tsm.ContactPair(node="up.end", beam="b", side="left")
    return replace(plain, beams=(*plain.beams, other), supports=(*plain.supports, *ends), contacts=(contact,))


SCENES = {
    "varying, on a face": lambda: pushed(offset=0.04, end_offset=0.02),
    "varying mixed": lambda: as_mixed(pushed(offset=0.03)),
    "leaning": leaning,
    "rubbed mixed, two on an element": lambda: cantilever(
        *(((x, 0.0), (x - 0.01, depth)) for x, depth in ((0.55, 0.05), (0.95, 0.114))),
        elements=2,
        friction=0.3,
    ),
    "rubbed mixed at once": lambda: cantilever(
        ((0.7, -0.03), (0.65, 0.1)), elements=2, offset=0.03, radius=0.01, friction=0.3
    ),
    "two on an element": lambda: cantilever(
        *(((x, -0.03), (x, depth - 0.03)) for x, depth in ((0.55, 0.1), (0.95, 0.228))),
        elements=2,
        offset=0.03,
    ),
    "rubbed exact": lambda: cantilever(
        ((1.0, -0.05), KS_PATH[1]),
        section=KS,
        element="exact",
        elements=2,
        offset=0.05,
        radius=0.03,
        friction=0.3,
    ),
    "beside a moving clamp": lambda: cantilever(
        ((0.3, -0.01), (0.3, 0.01)),
        elements=2,
        supports=(tsm.Support(beam="b", end="start", uy=-0.03, rotation=-0.05),),
        friction=0.2,
    ),
    "under a moving end": lambda: moving_end("exact"),
    "mixed under a moving end": lambda: moving_end("mixed"),
    "near a node": lambda: replace(pushed(), beams=(hook().beams[0].divided(0.504133),)),
}


@pytest.mark.slow_at("rubbed exact")
@pytest.mark.parametrize("name", SCENES)
def test_the_tangent_is_the_derivative(name):
    """In slip, in stick, and in the load parameter.

    Unknowns inside exact elements follow the others to second order, so central differences see the condensed tangent.
    """
    result = tsm.solve(SCENES[name](), np.array([0.4, 0.64]))
    newton = Newton(Model(result.model.structure), tsm.Settings())
    model = newton.model
    for equilibrium in result.equilibria:
        state = equilibrium.state
        assert any(state.touches)
        system = newton.assembler.linearise(state)
        matrix = newton.assembler.whole(system.tangent).toarray() / model.row_units[:, None] * model.units
        for seed in range(2):
            way = np.random.default_rng(seed).standard_normal(len(model.units))
            dt = 0.0 if seed else 1.0
            ends = [
                newton.update(state, h * way * model.units, system, t=state.load_parameter + h * dt)
                for h in (1e-5, -1e-5)
            ]
            apart = [newton.assembler.linearise(end).residual for end in ends]
            measured = (apart[0] - apart[1]) / 2e-5 / model.row_units
            expected = matrix @ way + dt * newton.assembler.rate(system) / model.row_units
            assert measured == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(expected).max())
