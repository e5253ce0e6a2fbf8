from dataclasses import replace
from functools import cache
from math import inf, nan

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.friction import (
    Friction,
    force_before_slip,
    mapped,
)
from fem_reference.settings import Settings
from fem_reference.status import Status
from fem_reference.touch import Condition
from tests.fem_reference.conftest import (
    PAIR,
    STRIP,
    loads,
    make_problem,
    make_strip,
)
from tests.fem_reference.rod_with_friction import EI, Touch, ks_path, slipping

# Rod of the KS scene: force and arc position at the end of the path, and load parameters of rest and of the second slip.
ROD = {
    0.1: (2.1935803158557e-3, 0.873335466586, (0.6254363, 0.6582915)),
    0.3: (2.110304862086e-3, 0.847142560461, (0.6204977, 0.6832873)),
    0.5: (2.122282811362e-3, 0.831119109269, (0.6140016, 0.7021081)),
}
FRICTIONLESS_ROD = 2.2882743071765e-3  # force at the end of the path, by the same shooting


def slip_changes(contact):
    """Load parameters at which a contact came to stick or began to slip, with the direction from there on."""
    return [
        (event.load_parameter, event.direction) for event in contact.events if event.kind in ("slip", "stick")
    ]


def ks(friction, n=20, settings=None, material="biot-linear", **contact):
    """The KS scene with friction, and the history of its contact."""
    values = {"friction": friction, "penalty": None} | contact
    result = fr.solve(make_problem(contact=values, material=material), loads(n), settings)
    return result, result.contacts[PAIR]


@cache
def rod(mu):
    """Equilibria of the rod at the load parameters of `ks`."""
    return ks_path(mu, ROD[mu][2], loads(20))


def shuttle(friction, n=12, radius=0.0, **contact):
    """A cantilever that a pin lifts by .05 and then rubs to and fro; the path turns at 1/6, 1/3 and 2/3."""
    y = (-0.01 if contact.get("surface") == "face" else 0.0) - radius
    path = ((0.8, y), (0.8, y + 0.05), (0.85, y + 0.05), (0.75, y + 0.05), (0.85, y + 0.05))
    values = {"friction": friction, "penalty": None} | contact
    scene = make_problem(path=path, radius=radius, contact=values, mesh=(40, 1), material="biot-linear")
    result = fr.solve(scene, loads(n))
    return result, result.contacts[PAIR]


FRICTION = Friction(zeta=0.5, tangent=(1.0, 0.0), stretch=1.0)


@pytest.mark.parametrize(
    ("direction", "force", "slip", "after"),
    [
        (0, 0.9, 0.0, (0, 0.9)),  # inside the cone
        (0, 1.0 + 1e-9, 0.0, (0, 1.0 + 1e-9)),  # beyond it by round-off
        (0, 1.5, 0.0, (1, 1.0)),
        (0, -1.5, 0.0, (-1, -1.0)),
        (1, 1.0, 0.1, (1, 1.0)),
        (1, 1.0, -0.1, (0, 1.0)),  # the slip would produce energy
        (-1, -1.0, 0.1, (0, -1.0)),
        (-1, -1.0, 1e-9, (-1, -1.0)),
    ],
)
def test_return_mapping(direction, force, slip, after):
    before = replace(FRICTION, direction=direction, force=force)
    result = mapped(before, slip, 1.0, (1e-8, 1e-8))
    assert (result.direction, result.force) == after


@pytest.mark.parametrize("friction", [-0.1, nan, inf])
def test_friction_that_is_no_coefficient_is_refused(friction):
    with pytest.raises(
        ValueError, match=r"^Contact\('pin->cantilever'\)\.friction = .*: must be finite and not"
    ):
        fr.Contact(node="pin", strip=STRIP, friction=friction)


def test_condition_after_opening_keeps_the_slip_and_has_no_force():
    friction = replace(FRICTION, direction=1, force=0.3, slip=0.2, dissipated=0.1)
    condition = Condition(closed=True, force=1.0, friction=friction).opened(armed=True)
    assert condition == Condition(friction=replace(FRICTION, slip=0.2, dissipated=0.1))


def test_block_sticks_up_to_the_cone_with_the_stiffness_of_a_bar():
    """A pin presses on a beam and drags it to a support: ``T = -EA x / a'`` up to ``mu N``, where a' counts the spread of T."""
    drop, drag, mu, a = 1e-5, 1.2e-7, 0.3, 0.5
    strip = make_strip(height=0.1, poissons_ratio=0.0, mesh=(40, 2), clamped=(), material="biot-linear")
    pin = fr.Pin(name="pin", path=((a, 0.0), (a, -drop), (a - drag, -drop)))
    problem = fr.SolidProblem(
        strips=(strip,),
        pins=(pin,),
        contacts=(fr.Contact(node="pin", strip=STRIP, side="left", friction=mu, spread=0.05),),
        supports=(
            fr.Support(strip=STRIP, end="start", motion=(0.0, 0.0, None)),
            fr.Support(strip=STRIP, end="end", motion=(None, 0.0, None)),
        ),
    )
    corner = drop / (drop + drag)
    dragged = corner + (1 - corner) * np.arange(13) / 12
    result = fr.solve(problem, np.append(0.5, dragged))
    contact, support = result.contacts[PAIR], result.supports[f"{STRIP}.start"]
    x = drag * np.arange(13) / 12
    curve = result.model.pairs[0].curve
    apart = np.abs(curve.offsets[:, None] - curve.offsets)
    length = a - curve.kernel @ apart @ curve.kernel / 2
    stiffness = strip.youngs_modulus * strip.width * strip.height / length
    T, N, way = (values[1:] for values in (contact.tangential_force, contact.normal_force, contact.direction))
    assert list(way) == sorted(way, reverse=True)
    stuck, slides = way == 0, way == -1
    assert stuck.sum() >= 4
    assert slides.sum() >= 4
    np.testing.assert_allclose((T - T[0])[stuck], -stiffness * x[stuck], rtol=0.01)
    assert np.ptp(contact.arc_position[1:][stuck]) < 1e-14
    ((slips, _),) = slip_changes(contact)
    assert slips * (drop + drag) - drop == pytest.approx((mu * N[0] + T[0]) / stiffness, rel=0.01)
    np.testing.assert_allclose(T[slides], -mu * N[slides], rtol=1e-9)
    # The start is the only horizontal support.
    np.testing.assert_allclose(support.force[:, 0], -contact.vector[:, 0], rtol=0, atol=1e-6 * mu * N[0])


@pytest.mark.slow
@pytest.mark.parametrize("mu", ROD)
def test_strip_with_friction_is_the_rod_at_every_load_parameter(mu):
    """Forces within 2e-3 and arc positions within 3e-4, with the linear law of the rod; 1.5e-3 and 2.5e-4 measured."""
    result, contact = ks(mu)
    forces = np.array([touch.force for touch in rod(mu)])
    np.testing.assert_allclose(contact.force, forces, rtol=2e-3)
    np.testing.assert_allclose(contact.arc_position, [touch.s for touch in rod(mu)], rtol=0, atol=3e-4)
    tangential = np.array([touch.T for touch in rod(mu)])
    stuck = contact.direction == 0
    np.testing.assert_allclose(contact.tangential_force[~stuck], tangential[~stuck], rtol=2e-3)
    np.testing.assert_allclose(contact.tangential_force, tangential, rtol=0, atol=5e-3 * forces.max())
    # The slide towards the clamp rests once.
    (rests, stick), (slips, back) = slip_changes(contact)
    assert (stick, back) == (0, 1)
    assert (rests, slips) == pytest.approx(ROD[mu][2], abs=3e-4)
    assert np.all(result.index == -1)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_friction_on_a_face_has_the_lever_of_half_the_height(radius):
    """The rod with the moment ``T h / 2`` at the contact: forces within 2e-3 in both slips, positions within 3e-4; 1.5e-3 measured."""
    result = rounded(20, radius, mesh=(50, 2))
    contact, start = result.contacts[PAIR], -0.01 - radius
    last, compared = Touch(N=3 * EI * 0.05, T=0.0, s=0.97, angle=0.05), 0
    for t in loads(40):
        pin = (1 - t) + 1j * (start + 2 / np.pi * t)
        last = slipping(pin, -0.3 if t < 0.65 else 0.3, last, lever=0.01, radius=radius)
        k = np.flatnonzero(np.isclose(result.load_parameter, t))
        if k.size and not 0.6 < t < 0.7:
            assert contact.force[k[0]] == pytest.approx(last.force, rel=2e-3)
            assert contact.arc_position[k[0]] == pytest.approx(last.s, abs=3e-4)
            compared += 1
    assert compared == 19


@pytest.mark.slow
@pytest.mark.parametrize("mu", ROD)
def test_friction_changes_the_strip_of_the_scenes_material_as_it_changes_the_rod(mu):
    """Saint Venant's law is softer than the rod's by 3.6e-3 at the end, with friction and without; friction differs by 5e-4."""
    _, plain = ks(0.0, material="st-venant-kirchhoff")
    _, rough = ks(mu, material="st-venant-kirchhoff")
    assert plain.force[-1] / FRICTIONLESS_ROD - 1 == pytest.approx(-3.6e-3, abs=1e-4)
    ratio = rough.force[-1] / plain.force[-1]
    assert ratio == pytest.approx(ROD[mu][0] / FRICTIONLESS_ROD, rel=5e-4)


ONE_STEP = Settings(first_step=0.5, largest_departure=0.9)


def rounded(n, radius, settings=None, mesh=(30, 1), mu=0.3):
    """The path of the KS scene with a pin that touches the face, with the rod's law."""
    y = -0.01 - radius
    contact = {"friction": mu, "penalty": None, "surface": "face"}
    path = ((1.0, y), (0.0, y + 2 / np.pi))
    load_parameters = loads(n) if isinstance(n, int) else n
    scene = make_problem(path=path, radius=radius, contact=contact, mesh=mesh, material="biot-linear")
    return fr.solve(scene, load_parameters, settings)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_answer_does_not_depend_on_the_load_steps(radius):
    """Force and position within 1e-10; dissipated energy within 1e-4 of 80 load parameters; even with steps of .5 at most."""
    many = rounded(80, radius).contacts[PAIR]
    for n, settings, energy in ((10, None, 1e-4), (1, None, 1e-4), (1, ONE_STEP, 0.1)):
        few = rounded(n, radius, settings).contacts[PAIR]
        assert few.force[-1] == pytest.approx(many.force[-1], rel=1e-10)
        assert few.arc_position[-1] == pytest.approx(many.arc_position[-1], abs=1e-10)
        assert few.dissipated[-1] == pytest.approx(many.dissipated[-1], rel=energy)
        # In stick the stretch of the rolled length is the mean of both ends of a step.
        np.testing.assert_allclose(
            slip_changes(few), slip_changes(many), rtol=0, atol=3e-6 if radius else 1e-8
        )


@pytest.mark.slow_at("0.0")
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_first_touch_within_a_step_is_located(radius):
    """A pin meets a strip obliquely: the slip counts from there, with 1, 8 or 50 load parameters."""
    y = -0.01 - radius
    contact = {"friction": 0.6, "penalty": None, "surface": "face"}
    scene = make_problem(path=((0.9, y - 0.2), (0.5, y + 0.2)), radius=radius, contact=contact, mesh=(40, 1))
    histories = [fr.solve(scene, loads(n)).contacts[PAIR] for n in (1, 8, 50)]
    for history in histories:
        assert history.force[-1] == pytest.approx(histories[-1].force[-1], rel=1e-9)
        assert history.slip[-1] == pytest.approx(histories[-1].slip[-1], abs=1e-5)
        assert history.direction[-1] == -1
    assert histories[-1].slip[-1] == pytest.approx(-0.153, abs=0.01)


@pytest.mark.slow_at("0.0-axis-1e-10", "0.03-face-1e-10", "0.03-face-None")
@pytest.mark.parametrize("penetration", [None, 1e-10])
@pytest.mark.parametrize(("radius", "surface"), [(0.0, "axis"), (0.03, "face")])
def test_pin_that_rubs_to_and_fro(radius, surface, penetration):
    """Forces stay in the cone and on it in slip; energy is dissipated only; the second stroke repeats the first."""
    result, contact = shuttle(0.3, n=24, radius=radius, surface=surface, penetration=penetration)
    cone = 0.3 * contact.normal_force
    assert np.all(np.abs(contact.tangential_force) <= cone * (1 + 1e-8))
    slips = contact.direction != 0
    np.testing.assert_allclose(contact.tangential_force[slips], (contact.direction * cone)[slips], rtol=1e-9)
    assert np.all(np.diff(contact.dissipated) >= 0)
    turns = [(0, 1 / 3), (-1, 1 / 3), (0, 2 / 3), (1, 2 / 3)]
    late = [(t, way) for t, way in slip_changes(contact) if t > 0.3]
    assert [way for _, way in late] == [way for way, _ in turns]
    np.testing.assert_allclose([t for t, _ in late], [t for _, t in turns], rtol=0, atol=5e-5)
    first, second = (np.argmin(np.abs(result.load_parameter - t)) for t in (1 / 3, 1.0))
    assert contact.force[second] == pytest.approx(contact.force[first], rel=1e-9)
    assert contact.slip[second] == pytest.approx(contact.slip[first], abs=1e-5)
    if penetration is not None:
        assert np.abs(contact.gap).max() < 1e-10


def test_strip_rolls_on_a_round_pin_that_sticks():
    """``rho d zeta = s R d theta``: the contact moves along the strip without slip."""
    radius = 0.05
    result = rounded(np.append(0.3, np.arange(0.6, 0.711, 0.005)), radius, mu=0.5)
    contact = result.contacts[PAIR]
    stuck = np.flatnonzero(contact.direction == 0)
    assert stuck.size > 10
    at = [result.states[k].touches[0].projection for k in stuck]
    zeta, stretch = (np.array([getattr(one, name) for one in at]) for name in ("zeta", "stretch"))
    angle = np.array([np.arctan2(*one.tangent[::-1]) for one in at])
    rolled = (stretch[1:] + stretch[:-1]) / 2 * np.diff(zeta) + radius * np.diff(angle)
    assert np.abs(rolled).max() < 1e-12
    assert np.ptp(zeta) > 1e-3
    assert np.ptp(contact.slip[stuck]) == 0


@pytest.mark.parametrize(
    ("mu", "limit", "at"),
    [
        (0.1, 0.890538486811, 0.499796765),
        (0.2, 0.948651379547, 0.522089468),
        (0.3, 1.007848170943, 0.543001429),
    ],
)
def test_limit_load_of_three_point_bending(mu, limit, at):
    """Elastica drawn in between rough supports: largest ``V a^2 / EI`` per side, within 1e-4; 4e-5 measured.

    At first the beam sticks. The shortening ``3 d^2 / 5 a`` of a cantilever with the deflection d strains it, and it slips where
    ``EA 3 d^2 / (5 a^2) = mu 3 EI d / a^3``, at ``d = 5 mu I / (A a)``. The force there is 37 times the round-off of a nodal force
    for mu = .1.
    """
    contact = bending(mu, (at,), 10).contacts["pin->half"]
    assert contact.vector[-1, 1] / BENDING == pytest.approx(limit, rel=1e-4)
    ((slips, way),) = slip_changes(contact)
    assert way == 1
    assert slips * at == pytest.approx(5 * mu * 0.01**2 / 12, rel=1e-2)


BENDING = 2.1e4 * 0.02 * 0.01**3 / 12


def bending(mu, depths, n, load=0.0):
    """Half a beam on a pin at the distance 1 from the middle, which the pin lifts to the given depths in turn.

    With a ``load`` on it, the middle is free to move down.
    """
    half = make_strip(
        name="half",
        end=(1.6, 0.0),
        height=0.01,
        poissons_ratio=0.0,
        mesh=(80, 1),
        clamped=(),
        material="biot-linear",
    )
    problem = fr.SolidProblem(
        strips=(half,),
        pins=(fr.Pin(name="pin", path=((1.0, 0.0), *((1.0, depth) for depth in depths))),),
        contacts=(fr.Contact(node="pin", strip="half", friction=mu),),
        supports=(fr.Support(strip="half", end="start", motion=(0.0, None if load else 0.0, 0.0)),),
        loads=(fr.EndLoad(strip="half", end="start", force=(0.0, -load)),) if load else (),
    )
    return fr.solve(problem, loads(n), throw=not load)


@pytest.mark.slow_at("0.1")
@pytest.mark.parametrize("mu", [0.1, 0.5])
def test_end_of_a_strip_rubs_on_another(mu):
    """Steps do not matter, and action and reaction cancel: the reactions of both clamps balance the load."""
    upper = make_strip(name="upper", start=(0.0, 0.1), end=(0.8, 0.05), mesh=(20, 1))
    lower = make_strip(name="lower", start=(1.0, 0.0), end=(0.1, 0.0), mesh=(20, 1))
    contact = fr.Contact(node="upper.end", strip="lower", surface="face", friction=mu)
    load = fr.EndLoad(strip="upper", force=(0.0, -4e-3))
    problem = fr.SolidProblem(strips=(upper, lower), contacts=(contact,), loads=(load,))
    once, often = (fr.solve(problem, loads(n)) for n in (1, 40))
    pair = "upper.end->lower"
    assert once.contacts[pair].force[-1] == pytest.approx(often.contacts[pair].force[-1], rel=1e-9)
    assert once.contacts[pair].slip[-1] == pytest.approx(often.contacts[pair].slip[-1], abs=1e-5)
    total = sum(often.supports[f"{name}.start"].force[-1] for name in ("upper", "lower"))
    np.testing.assert_allclose(total, [0.0, 4e-3], rtol=0, atol=1e-9)
    ratio = often.contacts[pair].tangential_force[-1] / often.contacts[pair].normal_force[-1]
    assert ratio == pytest.approx(mu, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.03])
def test_work_of_the_pin_is_stored_or_dissipated(radius):
    """Within 2e-4 at 100 load parameters, by the trapezoidal rule for the work, and a quarter of it at 200."""

    def error(n):
        result = rounded(n, radius)
        scene = result.model.problem
        history, t = result.contacts[PAIR], np.append(0.0, result.load_parameter)
        forces = np.vstack([[0.0, 0.0], history.vector])
        steps = np.diff([scene.pins[0].position(one) for one in t], axis=0)
        work = np.cumsum(np.sum((forces[1:] + forces[:-1]) / 2 * steps, axis=1))
        stored = np.array([sum(fr.energy(result, k)) for k in range(n)])
        assert history.dissipated[-1] > 0.1 * work[-1]
        return float(np.abs(stored + history.dissipated - work).max() / work[-1])

    coarse, fine = error(100), error(200)
    assert coarse < 2e-4
    assert fine < 0.35 * coarse


def test_slip_begins_with_the_force_before_it_unless_the_contact_has_turned():
    slips = replace(FRICTION, direction=1, force=0.5)
    assert [force_before_slip(slips, last) for last in (0.3, 0.0, -0.4)] == [0.3, 0.0, 0.5]


def drawn_scene(seed):
    """A cantilever under a rough pin, and under a second one, rough or smooth, on drawn paths."""
    rng = np.random.default_rng(seed)
    friction, radius = float(rng.choice([0.02, 0.1, 0.3, 0.6])), float(rng.choice([0.0, 0.02]))
    pins = []
    for number in range(int(rng.integers(1, 3))):
        side = 1 - 2 * number
        x, y = (0.9, 0.5)[number] + rng.uniform(-0.1, 0.05), -0.01 - radius - rng.choice([0.0, 0.02])
        path = [(x, side * y)]
        for _ in range(int(rng.integers(1, 5))):
            x = float(np.clip(x + rng.uniform(-0.2, 0.1), 0.2, 0.9))
            path.append((x, side * float(rng.uniform(0, 0.02 if number else 0.25) - 0.01 - radius)))
        pins.append(fr.Pin(name=f"pin{number}", path=tuple(path), radius=radius))
    contacts = tuple(
        fr.Contact(node=pin.name, strip=STRIP, side=side, surface="face", friction=mu)
        for pin, side, mu in zip(pins, ("right", "left"), (friction, friction * (seed % 2)), strict=False)
    )
    strip = make_strip(mesh=(30, 1), material="biot-linear")
    return fr.SolidProblem(strips=(strip,), pins=tuple(pins), contacts=contacts)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_drawn_scenes_do_not_depend_on_the_load_steps(seed):
    """Forces within 1e-5 of the largest for 3 and 30 load parameters."""
    scene = drawn_scene(seed)
    few, many = (fr.solve(scene, loads(n)) for n in (3, 30))
    largest = max(contact.force.max() for contact in many.contacts.values())
    assert largest > 0
    for spec in scene.contacts:
        contact = many.contacts[spec.name]
        cone = spec.friction * contact.normal_force
        assert few.contacts[spec.name].force[-1] == pytest.approx(contact.force[-1], abs=1e-5 * largest)
        assert np.all(np.abs(contact.tangential_force) <= cone + 1e-8 * largest)
        assert np.all(np.diff(contact.dissipated) >= 0)


def test_friction_ends_with_a_status_when_the_contact_is_lost():
    """A pin that drags a rough strip passes its tip."""
    scene = make_problem(
        path=((0.9, 0.0), (0.9, 0.02), (1.2, 0.02)), contact={"friction": 0.3, "penalty": None}, mesh=(20, 1)
    )
    result = fr.solve(scene, loads(10), throw=False)
    assert result.status is Status.LOST_CONTACT
