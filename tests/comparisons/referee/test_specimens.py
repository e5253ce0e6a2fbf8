"""The referee on loads along a beam, weight, natural curvature, taper, hinges, springs and forces inside a beam."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from comparisons.referee import AnswerState, Equilibrium, SearchStatus, answer_state, equilibrium
from comparisons.referee.admissible import least_gap
from comparisons.referee.basis import DEGREE
from comparisons.referee.elements import mesh_of, properties
from comparisons.referee.equations import System, assemble
from comparisons.referee.faces import face_slope, touching_distance
from comparisons.referee.layout import lay_out
from comparisons.referee.stability import _directions
from comparisons.referee.state import _tangents
from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    HingeSpec,
    LoadSpec,
    PinSpec,
    Scene,
    SpringSpec,
    SupportSpec,
)
from tests.comparisons.referee.forged import stated

MATERIAL = {"youngs_modulus": 1e6, "poissons_ratio": 0.3}
GRAVITY = (2.0, -20.0)


def strip(**more: object) -> BeamSpec:
    given = {
        "name": "a",
        "start": (0.0, 0.0),
        "end": (1.0, 0.1),
        "height": 0.05,
        "width": 1.0,
        "clamped": ("start",),
    }
    return BeamSpec(**(given | MATERIAL | more))


def undeformed(scene: Scene, t: float = 1.0, **more: dict) -> AnswerState:
    parts = np.linspace(0.0, 1.0, 41)
    axes = {
        beam.name: (parts * beam.length, np.array([beam.place(x) for x in parts])) for beam in scene.beams
    }
    nothing = {"arcs": {}, "forces": {}, "reactions": {}, "tips": {}}
    return AnswerState(load_parameter=t, axes=axes, **(nothing | more))


def found(scene: Scene, given: AnswerState | None = None) -> Equilibrium:
    exact = equilibrium(scene, given or undeformed(scene))
    assert exact.status is SearchStatus.FOUND, exact.message
    return exact


WEIGHT = {"beams": (strip(density=3.0),), "gravity": GRAVITY}
CURVED = {"beams": (strip(turn=0.8),)}
TAPERED = {"beams": (strip(height=(0.05, 0.03), width=(1.0, 0.6)),)}
TIP = {"loads": (LoadSpec(beam="a", end="end", force=(1.0, 6.0), moment=0.5),)}
PART = LoadSpec(beam="a", force_per_length=(5.0, -10.0), part=(0.15, 0.55))
INSIDE = LoadSpec(beam="a", at=0.8, force=(2.0, 3.0), moment=0.4)
SPRING = SpringSpec(beam="a", end="end", stiffness=(2.0, 5.0), rotation=0.4)
ALONE = {
    "weight": WEIGHT,
    "curvature": CURVED | TIP,
    "taper": TAPERED | TIP,
    "load on a part": {"beams": (strip(),), "loads": (PART,)},
    "force inside": {"beams": (strip(),), "loads": (INSIDE,)},
    "spring": {"beams": (strip(),), "springs": (SPRING,)} | TIP,
    "heavy taper": {"beams": (strip(density=3.0, height=(0.05, 0.03)),), "gravity": GRAVITY},
}  # fmt: skip


def everything() -> Scene:
    beam = strip(turn=0.8, density=3.0, height=(0.05, 0.03), width=(1.0, 0.6))
    return Scene(
        name="all", load_parameters=1, beams=(beam,), gravity=GRAVITY, loads=(PART, INSIDE), springs=(SPRING,),
        pins=(PinSpec(name="pin", start=(0.6, -0.15), displacement=(0.02, 0.2)),),
        contacts=(ContactSpec(node="pin", beam="a", side="right"),),
    )  # fmt: skip


def shot(scene: Scene, clamp: np.ndarray, contact: tuple[float, np.ndarray] | None) -> np.ndarray:
    """What the equations miss at the tip and at a contact, from the clamp on: nothing of it is the referee's own.

    Rates of ``x, y, theta, m, n_x, n_y`` by the arc length: ``theta' = m/EI + kappa0``, ``m' = -r' x n``, ``n' = -q``.
    """
    beam = scene.beams[0]
    L = beam.length
    stops: list[tuple[float, Callable[[np.ndarray], None]]] = []
    lines, missed = {}, []

    def rate(s: float, y: np.ndarray) -> list[float]:
        EA, GA, EI = beam.stiffness(s / L)
        c, d, n = math.cos(y[2]), math.sin(y[2]), y[4:]
        N, Q = n[0] * c + n[1] * d, n[1] * c - n[0] * d
        dx, dy = (1.0 + N / EA) * c - Q / GA * d, (1.0 + N / EA) * d + Q / GA * c
        q = beam.mass_per_length(s / L) * np.array(scene.gravity or (0.0, 0.0)) + sum(
            lines.values(), np.zeros(2)
        )
        return [dx, dy, y[3] / EI + beam.turn / L, dy * n[0] - dx * n[1], -q[0], -q[1]]

    for load in scene.loads:
        if load.force_per_length is not None:
            a, b = load.span
            stops.append((a * L, lambda _, load=load: lines.update({load: np.array(load.force_per_length)})))
            stops.append((b * L, lambda _, load=load: lines.pop(load)))
        elif load.at is not None:

            def act(y: np.ndarray, load: LoadSpec = load) -> None:
                y[3:] -= [load.moment, *load.force]

            stops.append((load.at * L, act))
    if contact is not None:

        def touch(y: np.ndarray) -> None:
            before = np.array(rate(contact[0], y)[:2])
            y[4:] -= contact[1]
            mean = before + rate(contact[0], y)[:2]
            missed.extend([*(y[:2] - scene.pins[0].position(1.0)), contact[1] @ mean])

        stops.append((contact[0], touch))
    direction = math.atan2(beam.end[1] - beam.start[1], beam.end[0] - beam.start[0])
    y, at = np.array([*beam.start, direction - beam.turn / 2.0, clamp[2], *clamp[:2]]), 0.0
    for stop, change in sorted([*stops, (L, lambda _: None)], key=lambda item: item[0]):
        y = solve_ivp(rate, (at, stop), y, method="DOP853", rtol=3e-14, atol=1e-15).y[:, -1]
        change(y)
        at = stop
    tip = [load for load in scene.loads if load.end is not None]
    held = np.array(
        [*(sum(np.array(item.force) for item in tip) + np.zeros(2)), sum(item.moment for item in tip)]
    )
    moved = np.array([*(y[:2] - beam.end), y[2] - direction - beam.turn / 2.0])
    for spring in scene.springs:
        held -= np.array([*spring.stiffness, spring.rotation]) * moved
    return np.array([*missed, *(y[[4, 5, 3]] - held)])


def step_to_truth(scene: Scene, exact: Equilibrium) -> np.ndarray:
    """One step of Newton's method from the referee's answer to the zero of `shot`, relative to the largest unknown."""
    reaction = exact.reactions["a.start"]
    contact = next(iter(exact.contacts.values()), None)
    z = np.array([*-reaction, *([] if contact is None else [contact.arc_position, *contact.force])])

    def off(z: np.ndarray) -> np.ndarray:
        return shot(scene, z[:3], None if contact is None else (float(z[3]), z[4:]))

    h = 1e-6
    jacobian = np.array([(off(z + h * e) - off(z - h * e)) / (2.0 * h) for e in np.eye(len(z))]).T
    return np.linalg.solve(jacobian, off(z)) / np.abs(z).max()


@pytest.mark.parametrize("key", ALONE)
def test_each_key_alone_against_shooting_to_1e_10(key: str) -> None:
    scene = Scene(name="alone", load_parameters=1, **ALONE[key])
    assert np.abs(step_to_truth(scene, found(scene))).max() < 1e-10


def test_all_keys_with_a_pin_in_contact_against_shooting_to_1e_10() -> None:
    scene = everything()
    rough = {"arcs": {"pin->a": 0.62}, "forces": {"pin->a": (-3.0, 10.0)}}
    exact = found(scene, undeformed(scene, **rough))
    assert np.abs(step_to_truth(scene, exact)).max() < 1e-10
    assert exact.index == 0


def test_the_hessian_is_the_derivative_of_the_gradient() -> None:
    first = strip(turn=1.1, end=(1.0, 0.2), height=(0.1, 0.06), width=(1.0, 1.4), density=2.0)
    second = strip(name="b", start=(1.0, 0.2), end=(1.4, -0.5), turn=-0.4, clamped=())
    scene = Scene(
        name="two", load_parameters=1, beams=(first, second), gravity=GRAVITY, loads=(PART, replace(INSIDE, beam="b")),
        pins=(
            PinSpec(name="p", start=(0.4, 0.3), displacement=(0.0, -0.3)),
            PinSpec(name="q", start=(0.6, 0.3), displacement=(0.0, -0.3), radius=0.05),
        ),
        contacts=(ContactSpec(node="p", beam="a", side="left"), ContactSpec(node="q", beam="a", side="left", surface="face")),
        hinges=(HingeSpec(beam="b", end="start", stiffness=0.3),), springs=(replace(SPRING, beam="b"),),
    )  # fmt: skip
    layout = lay_out(scene, 1.0, {"p->a": 0.45, "q->a": 0.6})
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 2) for _ in layout.parts])
    random, rods = np.random.default_rng(1), properties(layout, mesh)
    z = 0.1 * random.normal(size=mesh.unknowns)
    for touch, arc in zip(layout.touches, (0.45, 0.6), strict=True):
        z[touch.arc] = arc / layout.length
    bubbles = 0.02 * random.normal(size=(len(mesh.part), DEGREE - 1))

    def condensed(z: np.ndarray, iterations: int = 2) -> System:
        nonlocal bubbles
        for _ in range(iterations):
            system = assemble(layout, mesh, rods, z, bubbles)
            bubbles = bubbles - system.shift
        return system

    here, h = condensed(z, 20), 1e-6
    differences = np.array(
        [
            (condensed(z + h * e).gradient - condensed(z - h * e).gradient) / (2.0 * h)
            for e in np.eye(len(z))[: layout.unknowns]
        ]
    ).T
    size, hessian = np.abs(here.hessian).max(), here.hessian[:, : layout.unknowns]
    np.testing.assert_allclose(hessian, differences, rtol=0.0, atol=1e-7 * size)
    np.testing.assert_allclose(here.hessian, here.hessian.T, rtol=0.0, atol=1e-14 * size)


def test_three_hinges_carry_axial_forces_alone_to_1e_12() -> None:
    """Two bars between pins with a hinge at the apex: ``P = 2 EA (1 - l/l0) (h - v)/l`` at the deflection v."""
    left = strip(name="l", end=(1.0, 0.5), clamped=())
    right = strip(name="r", start=(1.0, 0.5), end=(2.0, 0.0), clamped=())
    pinned = (
        SupportSpec(beam="l", end="start", kind="pinned"), SupportSpec(beam="r", end="end", kind="pinned"),
    )  # fmt: skip
    scene = Scene(
        name="bars", load_parameters=1, beams=(left, right), supports=pinned,
        hinges=(HingeSpec(beam="r", end="start"),), loads=(LoadSpec(beam="l", end="end", force=(0.0, -500.0)),),
    )  # fmt: skip

    def missing(v: float) -> float:
        length = math.hypot(1.0, 0.5 - v)
        return 2.0 * left.EA * (1.0 - length / left.length) * (0.5 - v) / length - 500.0

    exact = found(scene)
    truth = brentq(missing, 0.0, 0.2, xtol=1e-15)
    assert 0.5 - exact.ends["l.end"][1] == pytest.approx(truth, rel=1e-12)
    assert exact.reactions["l.start"][1] == pytest.approx(250.0, rel=1e-12)


@pytest.mark.parametrize(("factor", "index"), [(0.999, 0), (1.001, 1)])
def test_a_column_buckles_under_its_weight_at_Greenhills_length(factor: float, index: int) -> None:
    """The height at which a heavy column buckles: q L^3/EI = 7.8373474, nine quarters of the square of the first zero of J_-1/3."""
    beam = strip(end=(0.0, 1.0), height=1e-3, density=1.0)
    q = factor * 7.837347438943 * beam.EI
    scene = Scene(name="column", load_parameters=1, beams=(beam,), gravity=(0.0, -q / 1e-3))
    assert found(scene).index == index


@pytest.mark.parametrize(("factor", "index"), [(0.999, 0), (1.001, 1)])
def test_a_column_on_a_spring_hinge_buckles_where_x_tan_x_is_k_L_over_EI(factor: float, index: int) -> None:
    beam = strip(end=(0.0, 1.0), height=1e-3)
    x = brentq(lambda x: x * math.tan(x) - 2.0, 0.5, 1.5, xtol=1e-14)
    push = (LoadSpec(beam="a", end="end", force=(0.0, -factor * x**2 * beam.EI)),)
    hinge = (HingeSpec(beam="a", end="start", stiffness=2.0 * beam.EI),)
    assert (
        found(Scene(name="column", load_parameters=1, beams=(beam,), loads=push, hinges=hinge)).index == index
    )


def on_a_sloping_face(side: str, turn: float, friction: float = 0.0) -> Scene:
    """A round pin pressed on the face of a thick strip whose height tapers, from where it touches the undeformed face."""
    beam = strip(end=(1.0, 0.0), turn=turn, height=(0.1, 0.06), poissons_ratio=0.3, density=None)
    spec = ContactSpec(node="pin", beam="a", side=side, surface="face", friction=friction)
    pin = PinSpec(
        name="pin", start=(0.6, 9.0 if side == "left" else -9.0), displacement=(0.0, 1.0), radius=0.1
    )
    scene = Scene(name="face", load_parameters=4, beams=(beam,), pins=(pin,), contacts=(spec,))
    s = 0.6 * beam.length
    tilt = math.asin(face_slope(scene, spec)) * (1.0 if side == "left" else -1.0)
    direction = math.atan2(*reversed(beam.tangent(0.6))) + tilt
    out = touching_distance(scene, spec, s) * (1.0 if side == "left" else -1.0)
    x, y = beam.place(0.6)
    start = (x - out * math.sin(direction), y + out * math.cos(direction))
    way = (0.02, -0.15 if side == "left" else 0.15)
    return replace(scene, pins=(replace(pin, start=start, displacement=way),))


def pressed(scene: Scene, t: float, near: Equilibrium | None) -> Equilibrium:
    """The equilibrium at t next to one at a smaller load parameter; the first one next to a straight strip under a small force."""
    (spec,), beam = scene.contacts, scene.beams[0]
    if near is None:
        stiffness = 3.0 * beam.EI / (0.6 * beam.length) ** 3
        push = stiffness * t * np.array(scene.pins[0].displacement) * [0.0, 1.0]
        rough = {
            "arcs": {spec.pair: 0.6 * beam.length},
            "forces": {spec.pair: (float(push[0]), float(push[1]))},
        }
        return found(scene, undeformed(scene, t, **rough))
    return found(scene, replace(answer_state(stated(scene, [near]), scene, 0), load_parameter=t))


@pytest.mark.parametrize(("side", "turn"), [("left", 0.7), ("right", 0.0)])
def test_the_work_on_a_face_that_tapers_is_the_strain_energy_to_1e_10(side: str, turn: float) -> None:
    scene = on_a_sloping_face(side, turn)
    points, weights = leggauss(8)
    way, work, near = np.array(scene.pins[0].displacement), 0.0, None
    for t, w in zip((1.0 + points) / 2.0, weights / 2.0, strict=True):
        near = pressed(scene, float(t), near)
        work += w * float(near.contacts["pin->a"].force @ way)
        assert near.index == 0
    exact = pressed(scene, 1.0, near)
    assert exact.strain_energy == pytest.approx(work, rel=1e-10)
    assert exact.contacts["pin->a"].push > 10.0
    gap, arc = least_gap(scene, exact, scene.contacts[0])
    # of the order of the square of the kink by shear, which lies between the two directions at the contact
    assert -1e-12 < gap < 1e-6
    assert arc == pytest.approx(exact.contacts["pin->a"].arc_position, abs=1e-3)


def test_the_direction_of_a_face_follows_the_variations_of_the_axis() -> None:
    """The angle phi is no unknown of its own where the index is counted: it changes as ``nu . (r'_- + r'_+)/2 = -offset'`` says."""
    scene = everything()
    beam = replace(scene.beams[0], height=(0.12, 0.06), poissons_ratio=0.4)
    contact = replace(scene.contacts[0], surface="face")
    scene = replace(
        scene,
        beams=(beam,),
        contacts=(contact,),
        pins=(replace(scene.pins[0], radius=0.05, start=(0.6, -0.25)),),
    )
    exact = found(scene, undeformed(scene, arcs={"pin->a": 0.62}, forces={"pin->a": (-10.0, 60.0)}))
    solution = exact.solution
    layout, z, touch = solution.layout, solution.z, solution.layout.touches[0]

    def phi(z: np.ndarray) -> float:
        x, y = sum(_tangents(replace(solution, z=z), touch)) / 2.0
        return math.atan2(y, x) + math.asin(touch.slope / math.hypot(x, y))

    assert phi(z) == pytest.approx(z[touch.angle], abs=1e-12)
    directions = _directions(solution)
    before, behind = layout.beside(touch)
    moved = [
        layout.stations[before.last].rotation_unknown,
        before.force,
        before.force + 1,
        behind.force,
        behind.force + 1,
    ]
    kept = [k for k in range(len(z)) if k != touch.angle]
    for k in [*moved, touch.arc]:
        e = 1e-6 * np.eye(len(z))[k]
        difference = (phi(z + e) - phi(z - e)) / 2e-6
        assert directions[touch.angle, kept.index(k)] == pytest.approx(difference, rel=1e-6, abs=1e-9)
