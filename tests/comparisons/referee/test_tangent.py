"""The tangent of the referee's equations: the Hessian with every key, the rows of friction, and the variations on which the index is counted."""

import math
from dataclasses import replace

import numpy as np
import pytest

# the equations off equilibrium are no answer of `equilibrium`, and an error of their tangent shows there as a few more iterations only
from comparisons.referee.elements import DEGREE, mesh_of
from comparisons.referee.equations import System, assemble, directions
from comparisons.referee.grip import Grip, Hold
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.path import tangent
from comparisons.scene import ContactSpec, HingeSpec, LoadSpec, PinSpec, Scene, StageSpec
from tests.comparisons.referee.forged import seen
from tests.comparisons.referee.test_specimens import (
    GRAVITY,
    HEAVY_TAPER,
    INSIDE,
    PART,
    SPRING,
    found,
    nearest,
    on_its_face,
    strip,
)

FIRST = strip(turn=1.1, end=(1.0, 0.2), height=(0.1, 0.06), width=(1.0, 1.4), density=2.0)
TWO = Scene(
    name="two", load_parameters=1, gravity=GRAVITY, loads=(PART, replace(INSIDE, beam="b")),
    beams=(FIRST, strip(name="b", start=(1.0, 0.2), end=(1.4, -0.5), turn=-0.4, clamped=())),
    pins=(
        PinSpec(name="p", start=(0.4, 0.3), displacement=(0.0, -0.3)),
        PinSpec(name="q", start=(0.6, 0.3), displacement=(0.0, -0.3), radius=0.05),
    ),
    contacts=(ContactSpec(node="p", beam="a", side="left"), ContactSpec(node="q", beam="a", side="left", surface="face")),
    hinges=(HingeSpec(beam="b", end="start", stiffness=0.3),), springs=(replace(SPRING, beam="b"),),
)  # fmt: skip
"""Every key at once, and two contacts without friction."""
HOLD = Hold(load_parameter=0.0, arc_position=0.7, stretch=1.02, shear=0.1, direction=0.3)


def on_a_face(height: float | tuple[float, float], hold: Hold | None) -> Layout:
    """A thick cantilever that slips, or sticks, on a round pin."""
    scene = Scene(
        name="face", load_parameters=1, beams=(strip(end=(1.0, 0.2), width=0.1, height=height),),
        pins=(PinSpec(name="p", path=((0.8, -0.2), (0.7, 0.2)), radius=0.15),),
        contacts=(ContactSpec(node="p", beam="a", side="right", surface="face", friction=0.4),),
    )  # fmt: skip
    grip = Grip(friction=0.4, slip=0 if hold else 1, hold=hold)
    return lay_out(scene, 0.6, {"p->a": 0.72}, {"p->a": grip})


LAYOUTS = {
    "every key": lay_out(TWO, 1.0, {"p->a": 0.45, "q->a": 0.6}),
    "slip": on_a_face(0.2, None),
    "stick": on_a_face(0.2, HOLD),
    "stick on a face that tapers": on_a_face((0.2, 0.1), HOLD),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_the_hessian_is_the_derivative_of_the_gradient(name):
    """At drawn unknowns, off equilibrium, with the unknowns inside the elements condensed."""
    layout = LAYOUTS[name]
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 2) for _ in layout.parts])
    random = np.random.default_rng(1)
    z = 0.1 * random.normal(size=mesh.unknowns)
    arcs = (0.45, 0.6) if name == "every key" else (0.72,)
    for touch, arc in zip(layout.touches.values(), arcs, strict=True):
        z[touch.arc] = arc / layout.length
    bubbles = 0.02 * random.normal(size=(len(mesh.part), DEGREE - 1))

    def condensed(z: np.ndarray, iterations: int = 3) -> System:
        nonlocal bubbles
        for _ in range(iterations):
            system = assemble(mesh, np.append(z, bubbles))
            bubbles = bubbles - system.shift
        return system

    here, h = condensed(z, 30), 1e-6
    steps = h * np.eye(len(z))[: layout.unknowns]
    columns = [(condensed(z + e).gradient - condensed(z - e).gradient) / (2.0 * h) for e in steps]
    hessian, size = here.hessian[:, : layout.unknowns], np.abs(here.hessian).max(axis=1, keepdims=True)
    assert (np.abs(hessian - np.array(columns).T) / size).max() < 1e-6
    symmetric = np.abs(here.hessian - here.hessian.T).max() < 1e-14 * size.max()
    assert symmetric == (not bool(layout.grips))


def test_the_direction_of_a_face_follows_the_variations_of_the_axis():
    """The angle phi is no unknown of its own where the index is counted: it changes as ``nu . (r'_- + r'_+)/2 = -offset'`` says."""
    exact = nearest(on_its_face())
    layout, z, touch = exact.layout, exact.z, next(iter(exact.layout.touches.values()))

    def phi(z: np.ndarray) -> float:
        x, y = sum(replace(exact, z=z).tangents(touch)) / 2.0
        return math.atan2(y, x) + math.asin(touch.face.tilt / math.hypot(x, y))

    assert phi(z) == pytest.approx(z[touch.angle], abs=1e-12)
    free = directions(exact.mesh, z)
    before, behind = layout.beside(touch)
    forces = [part.force + k for part in (before, behind) for k in range(2)]
    kept = [k for k in range(exact.mesh.unknowns) if k != touch.angle]
    for k in [layout.stations[touch.station].numbers[2], *forces, touch.arc]:
        e = 1e-6 * np.eye(len(z))[k]
        difference = (phi(z + e) - phi(z - e)) / 2e-6
        assert free[touch.angle, kept.index(k)] == pytest.approx(difference, rel=1e-6, abs=1e-9)


def test_nothing_moves_in_a_stage_that_changes_nothing():
    """The round-off of an equilibrium does not count as a rate: over a short step it would lead the path elsewhere."""
    rest = StageSpec(load_parameters=1, load=(LoadSpec(beam="a", end="start", force=(0.0, 1.0)),))
    idle = Scene(name="idle", load_parameters=2, stages=(rest,), **HEAVY_TAPER)
    for rate in tangent(found(idle, seen(idle, 1.5)), 1e-7):
        assert not np.any(rate)
