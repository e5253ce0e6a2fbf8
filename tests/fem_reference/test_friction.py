"""Friction against a rod by shooting, a bar, and elasticas; its energy; and answers whatever the load steps."""

from functools import cache

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import PAIR, STRIP, loads, make_problem, make_strip, upper_on_lower
from tests.fem_reference.rod_with_friction import EI, Touch, ks_path, slipping

# Rod of the KS scene: force at the end of the path, and load parameters of rest and of the second slip.
ROD = {
    0.1: (2.1935803158557e-3, (0.6254363, 0.6582915)),
    0.3: (2.110304862086e-3, (0.6204977, 0.6832873)),
    0.5: (2.122282811362e-3, (0.6140016, 0.7021081)),
}
FRICTIONLESS_ROD = 2.2882743071765e-3  # force at the end of the path, by the same shooting


def slip_changes(contact):
    """Load parameters at which a contact came to stick or began to slip, with the direction from there on."""
    return [
        (event.load_parameter, event.direction) for event in contact.events if event.kind in ("slip", "stick")
    ]


def rubbed(
    friction, n=20, settings=None, path=None, mesh=(50, 2), radius=0.0, material="biot-linear", **contact
):
    """The KS scene with friction, or another path of its pin, and the history of its contact."""
    values = {"friction": friction, "penalty": None} | contact
    scene = make_problem(path=path, radius=radius, contact=values, material=material, mesh=mesh)
    result = fr.solve(scene, loads(n) if isinstance(n, int) else n, settings)
    return result, result.contacts[PAIR]


def shuttle(friction, n, radius=0.0, **contact):
    """A cantilever that a pin lifts by .05 and then rubs to and fro; the path turns at 1/6, 1/3 and 2/3."""
    y = (-0.01 if contact.get("surface") == "face" else 0.0) - radius
    path = ((0.8, y), (0.8, y + 0.05), (0.85, y + 0.05), (0.75, y + 0.05), (0.85, y + 0.05))
    return rubbed(friction, n, path=path, mesh=(40, 1), radius=radius, **contact)


def test_block_sticks_up_to_the_cone_with_the_stiffness_of_a_bar():
    """A pin presses on a beam and drags it to a support: ``T = -EA x / a'`` up to ``mu N``, where a' counts the spread of T."""
    drop, drag, mu, a, spread = 1e-5, 1.2e-7, 0.3, 0.5, 0.05
    strip = make_strip(height=0.1, poissons_ratio=0.0, mesh=(40, 2), clamped=(), material="biot-linear")
    pin = fr.Pin(name="pin", path=((a, 0.0), (a, -drop), (a - drag, -drop)))
    problem = fr.SolidProblem(
        strips=(strip,),
        pins=(pin,),
        contacts=(fr.Contact(node="pin", strip=STRIP, side="left", friction=mu, spread=spread),),
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
    g, w = np.polynomial.legendre.leggauss(
        12
    )  # the kernel of the contact's average, (Gasser, Mueller, Mammitzsch)
    kernel = w * (3 - 10 * g**2 + 7 * g**4)
    kernel = kernel / kernel.sum()
    length = a - kernel @ (spread * np.abs(g[:, None] - g)) @ kernel / 2
    stiffness = strip.youngs_modulus * strip.width * strip.height / length
    T, N, way = (values[1:] for values in (contact.tangential_force, contact.normal_force, contact.direction))
    assert list(way) == sorted(way, reverse=True)
    stuck, slides = way == 0, way == -1
    assert min(stuck.sum(), slides.sum()) >= 4
    np.testing.assert_allclose((T - T[0])[stuck], -stiffness * x[stuck], rtol=0.01)
    assert np.ptp(contact.arc_position[1:][stuck]) < 1e-14
    ((slips, _),) = slip_changes(contact)
    assert slips * (drop + drag) - drop == pytest.approx((mu * N[0] + T[0]) / stiffness, rel=0.01)
    np.testing.assert_allclose(T[slides], -mu * N[slides], rtol=1e-9)
    # The start is the only horizontal support.
    np.testing.assert_allclose(support.force[:, 0], -contact.vector[:, 0], rtol=0, atol=1e-6 * mu * N[0])


@cache
def rod(mu):
    """Equilibria of the rod at the load parameters of `rubbed`."""
    return ks_path(mu, ROD[mu][1], loads(20))


@pytest.mark.slow
@pytest.mark.parametrize("mu", ROD)
def test_strip_with_friction_is_the_rod_at_every_load_parameter(mu):
    """Forces within 2e-3 and arc positions within 3e-4, with the linear law of the rod; 1.5e-3 and 2.5e-4 measured."""
    result, contact = rubbed(mu)
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
    assert (rests, slips) == pytest.approx(ROD[mu][1], abs=3e-4)
    assert np.all(result.index == -1)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_friction_on_a_face_has_the_lever_of_half_the_height(radius):
    """The rod with the moment ``T h / 2`` at the contact: forces within 2e-3 in both slips, positions within 3e-4; 1.5e-3 measured."""
    result, contact = rubbed(0.3, radius=radius, surface="face")
    last, compared = Touch(N=3 * EI * 0.05, T=0.0, s=0.97, angle=0.05), 0
    for t in loads(40):
        pin = (1 - t) + 1j * (2 / np.pi * t - 0.01 - radius)
        last = slipping(pin, -0.3 if t < 0.65 else 0.3, last, lever=0.01, radius=radius)
        k = np.flatnonzero(np.isclose(result.load_parameter, t))
        if k.size and not 0.6 < t < 0.7:
            assert contact.force[k[0]] == pytest.approx(last.force, rel=2e-3)
            assert contact.arc_position[k[0]] == pytest.approx(last.s, abs=3e-4)
            compared += 1
    assert compared == 19


@pytest.mark.slow
def test_friction_changes_the_strip_of_the_scenes_material_as_it_changes_the_rod():
    """Saint Venant's law is softer than the rod's by 3.6e-3 at the end, with friction and without; friction differs by 5e-4."""
    plain, *rough = (rubbed(mu, 1, material="st-venant-kirchhoff")[1].force[-1] for mu in (0.0, *ROD))
    assert plain / FRICTIONLESS_ROD - 1 == pytest.approx(-3.6e-3, abs=1e-4)
    for force, (rods, _) in zip(rough, ROD.values(), strict=True):
        assert force / plain == pytest.approx(rods / FRICTIONLESS_ROD, rel=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_answer_does_not_depend_on_the_load_steps(radius):
    """Force and position within 1e-10; dissipated energy within 1e-4 of 80 load parameters; even with steps of .5 at most."""
    values = {"radius": radius, "mesh": (30, 1), "surface": "face"}
    many = rubbed(0.3, 80, **values)[1]
    large = fr.Settings(first_step=0.5, largest_departure=0.9)
    for n, settings, energy in ((10, None, 1e-4), (1, None, 1e-4), (1, large, 0.1)):
        few = rubbed(0.3, n, settings, **values)[1]
        assert few.force[-1] == pytest.approx(many.force[-1], rel=1e-10)
        assert few.arc_position[-1] == pytest.approx(many.arc_position[-1], abs=1e-10)
        assert few.dissipated[-1] == pytest.approx(many.dissipated[-1], rel=energy)
        # In stick the stretch of the rolled length is the mean of both ends of a step.
        allowed = 3e-6 if radius else 1e-8
        np.testing.assert_allclose(slip_changes(few), slip_changes(many), rtol=0, atol=allowed)


@pytest.mark.slow_at("0.0")
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_first_touch_within_a_step_is_located(radius):
    """A pin meets a strip obliquely: the slip counts from there, with 1, 8 or 50 load parameters."""
    y = -0.01 - radius
    values = {"path": ((0.9, y - 0.2), (0.5, y + 0.2)), "radius": radius, "surface": "face", "mesh": (40, 1)}
    histories = [rubbed(0.6, n, material="st-venant-kirchhoff", **values)[1] for n in (1, 8, 50)]
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
    result, contact = shuttle(0.3, 24, radius=radius, surface=surface, penetration=penetration)
    cone = 0.3 * contact.normal_force
    assert np.all(np.abs(contact.tangential_force) <= cone * (1 + 1e-8))
    assert np.all(result.index == -1)
    slips = contact.direction != 0
    np.testing.assert_allclose(contact.tangential_force[slips], (contact.direction * cone)[slips], rtol=1e-9)
    assert np.all(np.diff(contact.dissipated) >= 0)
    late = [(t, way) for t, way in slip_changes(contact) if t > 0.3]
    assert [way for _, way in late] == [0, -1, 0, 1]
    np.testing.assert_allclose([t for t, _ in late], [1 / 3, 1 / 3, 2 / 3, 2 / 3], rtol=0, atol=5e-5)
    first, second = (np.argmin(np.abs(result.load_parameter - t)) for t in (1 / 3, 1.0))
    assert contact.force[second] == pytest.approx(contact.force[first], rel=1e-9)
    assert contact.slip[second] == pytest.approx(contact.slip[first], abs=1e-5)
    if penetration is not None:
        assert np.abs(contact.gap).max() < 1e-10


def test_strip_rolls_on_a_round_pin_that_sticks():
    """``rho d zeta = s R d theta``: the contact moves along the strip without slip."""
    radius, n = 0.05, np.append(0.3, np.arange(0.6, 0.711, 0.005))
    result, contact = rubbed(0.5, n, radius=radius, mesh=(30, 1), surface="face")
    stuck = np.flatnonzero(contact.direction == 0)
    assert stuck.size > 10
    at = [result.states[k].touches[0].projection for k in stuck]
    zeta, stretch = contact.arc_position[stuck], np.array([one.stretch for one in at])
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
    section = {"height": 0.01, "poissons_ratio": 0.0, "material": "biot-linear"}
    half = make_strip(name="half", end=(1.6, 0.0), mesh=(80, 1), clamped=(), **section)
    problem = fr.SolidProblem(
        strips=(half,),
        pins=(fr.Pin(name="pin", path=((1.0, 0.0), (1.0, at))),),
        contacts=(fr.Contact(node="pin", strip="half", friction=mu),),
        supports=(fr.Support(strip="half", end="start", motion=(0.0, 0.0, 0.0)),),
    )
    contact = fr.solve(problem, loads(10)).contacts["pin->half"]
    assert contact.vector[-1, 1] / half.bending_stiffness == pytest.approx(limit, rel=1e-4)
    ((slips, way),) = slip_changes(contact)
    assert way == 1
    assert slips * at == pytest.approx(5 * mu * 0.01**2 / 12, rel=1e-2)


@pytest.mark.slow_at("0.1")
@pytest.mark.parametrize("mu", [0.1, 0.5])
def test_end_of_a_strip_rubs_on_another(mu):
    """Steps do not matter, and action and reaction cancel: the reactions of both clamps balance the load."""
    once, often = (fr.solve(upper_on_lower((20, 1), friction=mu), loads(n)) for n in (1, 40))
    (a,), (b,) = once.contacts.values(), often.contacts.values()
    assert a.force[-1] == pytest.approx(b.force[-1], rel=1e-9)
    assert a.slip[-1] == pytest.approx(b.slip[-1], abs=1e-5)
    total = sum(often.supports[f"{name}.start"].force[-1] for name in ("upper", "lower"))
    np.testing.assert_allclose(total, [0.0, 4e-3], rtol=0, atol=1e-9)
    assert b.tangential_force[-1] / b.normal_force[-1] == pytest.approx(mu, rel=1e-9)


def energy_error(n, radius, path=None):
    """Largest difference of work, by the trapezoidal rule, and stored and dissipated energy, over the work."""
    result, history = rubbed(0.3, n, path=path, radius=radius, mesh=(30, 1), surface="face")
    pin, t = result.model.problem.pins[0], np.append(0.0, result.load_parameter)
    forces = np.vstack([[0.0, 0.0], history.vector])
    steps = np.diff([pin.position(one) for one in t], axis=0)
    work = np.cumsum(np.sum((forces[1:] + forces[:-1]) / 2 * steps, axis=1))
    stored = np.array([sum(fr.energy(result, k)) for k in range(n)])
    assert history.dissipated[-1] > 0.1 * work[-1]
    return float(np.abs(stored + history.dissipated - work).max() / work[-1])


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.03])
def test_work_of_the_pin_is_stored_or_dissipated(radius):
    """Within 2e-4 at 100 load parameters, and a quarter of it at 200."""
    coarse, fine = energy_error(100, radius), energy_error(200, radius)
    assert coarse < 2e-4
    assert fine < 0.35 * coarse


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
    path = ((0.9, 0.0), (0.9, 0.02), (1.2, 0.02))
    scene = make_problem(path=path, contact={"friction": 0.3, "penalty": None}, mesh=(20, 1))
    assert fr.solve(scene, loads(10), throw=False).status is fr.Status.LOST_CONTACT
