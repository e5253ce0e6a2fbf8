"""Tangents of whole structures are the derivatives of their residuals, and lead Newton's method to the square of its error."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import KS, KS_PATH, SECTION, as_mixed, cantilever, hook, leaning, pushed

# a residual and its tangent at a state that is no equilibrium are nowhere public
from tsm.model.model import Model
from tsm.system.newton import Newton

MOVING = tsm.Support(beam="b", end="start", uy=-0.03, rotation=-0.05)


def moving_end(element):
    """A cantilever that the end of another beam presses down, which a support moves."""
    plain = cantilever(element=element, elements=2)
    other = replace(plain.beams[0], name="up", start=(0.8, 0.5), end=(0.8, 0.0))
    ends = (tsm.Support(beam="up", end=end, uy=-0.1, rotation=0.0) for end in ("start", "end"))
    contact = tsm.ContactPair(node="up.end", beam="b", side="left")
    return replace(plain, beams=(*plain.beams, other), supports=(*plain.supports, *ends), contacts=(contact,))


def raised(y, x, depth, move=0.0):
    """A way of a pin by a depth, and along the beam."""
    return (x, y), (x + move, y + depth)


def two(y, first, second, move=0.0):
    return [raised(y, 0.55, first, move), raised(y, 0.95, second, move)]


RUBBED = {"element": "exact", "section": KS, "offset": 0.05, "radius": 0.03}
CANTILEVERS = {  # ways of pins, coefficient of friction, more of the beam and its contacts
    "rubbed mixed, two on an element": (two(0.0, 0.05, 0.114, -0.01), 0.3, {}),
    "rubbed exact, two on an element": (two(-0.05, 0.05, 0.114, -0.01), 0.3, {**RUBBED, "section": SECTION}),
    "rubbed mixed at once": ([((0.7, -0.03), (0.65, 0.1))], 0.3, {"offset": 0.03, "radius": 0.01}),
    "two on an element": (two(-0.03, 0.1, 0.228), 0.0, {"offset": 0.03}),
    "rubbed exact": ([((1.0, -0.05), KS_PATH[1])], 0.3, RUBBED),
    "beside a moving clamp": ([raised(-0.01, 0.3, 0.02)], 0.2, {"supports": (MOVING,)}),
}
BY_AN_ENERGY = ("two on an element", "mixed under a moving end")
"""Scenes of closed forms without friction."""
SCENES = {
    "varying, on a face": pushed(offset=0.04, end_offset=0.02),
    "varying mixed": as_mixed(pushed(offset=0.03)),
    "leaning": leaning(),
    "under a moving end": moving_end("exact"),
    "mixed under a moving end": moving_end("mixed"),
    "near a node": replace(pushed(), beams=(hook().beams[0].divided(0.504133),)),
    **{
        name: cantilever(*ways, elements=2, friction=friction, **more)
        for name, (ways, friction, more) in CANTILEVERS.items()
    },
}


@pytest.mark.slow_at("rubbed exact")
@pytest.mark.parametrize("name", SCENES)
def test_the_tangent_is_the_derivative(name):
    """In slip, in stick, and in the load parameter; what derives from an energy is symmetric.

    Unknowns inside exact elements follow the others to second order, so central differences see the condensed tangent.
    """
    result = tsm.solve(SCENES[name], np.array([0.4, 0.64]))
    newton = Newton(Model(result.model.structure), tsm.Settings())
    model = newton.model
    for equilibrium in result.equilibria:
        state = equilibrium.state
        assert any(state.touches)
        system = newton.assembler.linearise(state)
        whole = newton.assembler.whole(system.tangent).toarray()
        if name in BY_AN_ENERGY:
            assert np.abs(whole - whole.T).max() <= 1e-14 * np.abs(whole).max()
        matrix = whole / model.row_units[:, None] * model.units
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
