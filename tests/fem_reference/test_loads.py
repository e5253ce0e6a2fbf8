"""Loads inside a strip, taper, springs and hinges against beam theory by quadrature, with small loads."""

import numpy as np
import pytest
from scipy.integrate import quad

import fem_reference as fr
from fem_reference.model import build
from fem_reference.state import build_state, residual, tie_residuals
from fem_reference.tangent import linearise
from tests.fem_reference.conftest import STEP, STRIP, B, E, dense_hessian, make_strip

H = 0.02
GA = 5 / 6 * E / 2.6 * B
"""Shear stiffness over the height."""
SMALL = 1e-6 * make_strip().bending_stiffness
ROOT, TIP = f"{STRIP}.start", f"{STRIP}.end"


def tip(problem):
    """Deflection of a strip's tip under a small load, with index and statuses checked."""
    result = fr.solve(problem, np.array([1.0]))
    assert result.index[-1] == 0
    return result, float(result.tips[problem.strips[0].name][-1, 1])


def deflection(moment, shear, height=lambda _: H, width=lambda _: B):
    """Deflection by virtual work: moment and shear of the load times those of a unit force at the tip."""

    def work(x):
        bent = moment(x) * (1 - x) / (E * width(x) * height(x) ** 3 / 12)
        return bent + shear(x) / (GA / B * width(x) * height(x))

    points = [0.3, 0.437, 0.5, 0.73]
    return quad(work, 0, 1, points=points, epsabs=0, epsrel=1e-10, limit=200)[0]


def part_of(a, b):
    """Moment and shear of a unit force per length between a and b."""

    def shear(x):
        return max(b - max(a, x), 0.0)

    return lambda x: max(b - max(a, x), 0.0) * ((max(a, x) + b) / 2 - x), shear


LOADS = {
    "line": (fr.LineLoad(strip=STRIP, force=((0.0, -SMALL),)), part_of(0, 1)),
    "part": (fr.LineLoad(strip=STRIP, force=((0.0, -SMALL),), part=(0.3, 0.73)), part_of(0.3, 0.73)),
    "point": (
        fr.PointLoad(strip=STRIP, at=0.437, force=(0.0, -SMALL)),
        (lambda x: max(0.437 - x, 0.0), lambda x: float(x < 0.437)),
    ),
    "point between elements": (
        fr.PointLoad(strip=STRIP, at=0.5, force=(0.0, -SMALL)),
        (lambda x: max(0.5 - x, 0.0), lambda x: float(x < 0.5)),
    ),
}


@pytest.mark.parametrize("name", LOADS)
def test_a_load_inside_a_strip_deflects_it_as_a_beam_with_shear(name):
    load, (moment, shear) = LOADS[name]
    result, found = tip(fr.SolidProblem(strips=(make_strip(),), inner_loads=(load,)))
    assert found == pytest.approx(-SMALL * deflection(moment, shear), rel=1e-4)
    assert result.supports[ROOT].force[-1] == pytest.approx(
        [0, SMALL * shear(0.0)], rel=1e-6, abs=1e-5 * SMALL
    )
    assert result.supports[ROOT].moment[-1] == pytest.approx(SMALL * moment(0.0), rel=1e-9)


@pytest.mark.parametrize(("end_height", "end_width"), [(0.01, None), (0.03, 0.01), (None, 0.005)])
def test_a_tapered_strip_deflects_as_its_sections_bend(end_height, end_width):
    """With its own weight, whose force per length is quadratic, at h/L = .02: within 2e-4."""
    strip = make_strip(end_height=end_height, end_width=end_width)
    h1, b1 = end_height or H, end_width or B
    height, width = (lambda x: H + x * (h1 - H)), (lambda x: B + x * (b1 - B))
    density = SMALL / (B * H)
    area = [B * H, B * (h1 - H) + H * (b1 - B), (h1 - H) * (b1 - B)]
    weight = fr.LineLoad(strip=STRIP, force=tuple((0.0, -density * a) for a in area))

    def shear(x):
        return sum(a * (1 - x ** (k + 1)) / (k + 1) for k, a in enumerate(area))

    def moment(x):
        return sum(
            a * ((1 - x ** (k + 2)) / (k + 2) - x * (1 - x ** (k + 1)) / (k + 1)) for k, a in enumerate(area)
        )

    result, found = tip(fr.SolidProblem(strips=(strip,), inner_loads=(weight,)))
    assert found == pytest.approx(-density * deflection(moment, shear, height, width), rel=2e-4)
    body = result.model.bodies[0]
    volume = quad(lambda x: height(x) * width(x), 0, 1)[0]
    assert body.mesh.weights.sum() == pytest.approx(volume, rel=1e-12)
    assert result.supports[ROOT].force[-1, 1] == pytest.approx(density * volume, rel=1e-10)
    forces = fr.section_forces(result, STRIP, 0)
    x = forces.stations[10]
    assert forces.V[10] == pytest.approx(-density * shear(x), rel=1e-6)
    assert forces.M[10] == pytest.approx(-density * moment(x), rel=1e-6)


def test_a_face_contact_is_on_the_face_of_the_taper():
    """A sharp pin touches the inclined face at the start; below it, it is refused."""
    strip = make_strip(end_height=0.01)
    contact = fr.Contact(node="pin", strip=STRIP, side="left", surface="face")

    def problem(y):
        pin = fr.Pin(name="pin", path=((0.6, y), (0.6, y - 1e-6)))
        return fr.SolidProblem(strips=(strip,), pins=(pin,), contacts=(contact,))

    face = (H - 0.6 * 0.01) / 2
    with pytest.raises(ValueError, match="must not start beyond the left face"):
        problem(face - 1e-6)
    result = fr.solve(problem(face), np.array([1.0]))
    x, y = result.contacts[f"pin->{STRIP}"].vector[-1]
    assert x / y == pytest.approx(-np.tan(-0.005), rel=2e-3)  # normal to the face, which falls by .005


def test_springs_to_the_ground_carry_what_they_are_loaded_by():
    """A strip that only springs hold: forces by hand, the energy of the springs, and a stable state."""
    k = 3 * make_strip().bending_stiffness
    springs = (
        fr.Spring(strip=STRIP, end="start", stiffness=(k, k, 0.0)),
        fr.Spring(strip=STRIP, end="end", stiffness=(0.0, 2 * k, 0.0)),
    )
    load = fr.LineLoad(strip=STRIP, force=((0.0, -SMALL),))
    problem = fr.SolidProblem(strips=(make_strip(clamped=()),), springs=springs, inner_loads=(load,))
    result, _ = tip(problem)
    assert result.springs[ROOT].force[-1, 1] == pytest.approx(SMALL / 2, rel=1e-9)
    assert result.springs[TIP].force[-1, 1] == pytest.approx(SMALL / 2, rel=1e-9)
    assert result.model.problem.springs[0].motion == (0.0, 0.0, None)
    assert float(result.tips[STRIP][-1, 1]) == pytest.approx(-SMALL / 4 / k, rel=1e-7)
    assert not result.supports


def test_a_rotational_spring_turns_with_its_moment():
    """By any angle: a strip on a hinge with a spring, turned by a moment of 4 rad times its stiffness."""
    k = 1e-3 * make_strip().bending_stiffness
    problem = fr.SolidProblem(
        strips=(make_strip(clamped=(), mesh=(8, 1)),),
        supports=(fr.Support(strip=STRIP, end="start", motion=(0.0, 0.0, None)),),
        springs=(fr.Spring(strip=STRIP, end="start", stiffness=(0.0, 0.0, k)),),
        loads=(fr.EndLoad(strip=STRIP, moment=4 * k),),
    )
    result = fr.solve(problem, np.arange(1, 9) / 8)
    assert result.springs[ROOT].moment[-1] == pytest.approx(-4 * k, rel=1e-8)
    angle = np.arctan2(*result.tips[STRIP][-1][::-1]) % (2 * np.pi)
    assert angle == pytest.approx(4.0 + 0.002, abs=1e-7)  # half of the strip's own turn of .004


@pytest.mark.parametrize("stiffness", [(), (5.0,)])
def test_a_hinge_between_two_strips_bears_its_springs_moment(stiffness):
    """Two clamped halves, loaded at the hinge: by beam theory with shear, and a spring in the hinge that stays without moment by symmetry."""
    EI = make_strip().bending_stiffness
    halves = (
        make_strip(name="a", end=(0.5, 0.0), mesh=(25, 2)),
        make_strip(name="b", start=(0.5, 0.0), clamped=("end",), mesh=(25, 2)),
    )
    joint = fr.Joint(
        ends=("a.end", "b.start"), hinged=("b.start",), stiffness=tuple(EI * k for k in stiffness)
    )
    load = fr.EndLoad(strip="a", force=(0.0, -SMALL))
    result, found = tip(fr.SolidProblem(strips=halves, joints=(joint,), loads=(load,)))
    c = EI * sum(stiffness)
    # each half: force SMALL/2 and moment m = c 2 turn against its turn at the hinge
    a = 0.5
    m = 2 * c * (SMALL / 2 * a**2 / 2 / EI) / (1 + 2 * c * a / EI)
    expected = SMALL / 2 * a**3 / 3 / EI - m * a**2 / 2 / EI + SMALL / 2 * a / (GA * H)
    assert found == pytest.approx(-expected, rel=2e-4)
    assert result.supports["a.start"].moment[-1] == pytest.approx(SMALL / 2 * a - m, rel=1e-7)


def test_the_tangent_is_exact_with_springs_hinges_and_a_moment_inside():
    """By complex steps of displacements, and by the forces of the ties."""
    EI = make_strip().bending_stiffness
    strips = (
        make_strip(name="a", end=(0.5, 0.0), mesh=(4, 1), end_height=0.03),
        make_strip(name="b", start=(0.5, 0.0), end=(0.5, 0.5), clamped=(), mesh=(4, 1)),
    )
    problem = fr.SolidProblem(
        strips=strips,
        joints=(fr.Joint(ends=("a.end", "b.start"), hinged=("b.start",), stiffness=(EI,)),),
        springs=(fr.Spring(strip="b", end="end", stiffness=(EI, 2 * EI, 3 * EI)),),
        inner_loads=(
            fr.LineLoad(strip="b", force=((EI, 0.0), (0.0, EI))),
            fr.PointLoad(strip="a", at=0.3, moment=EI),
        ),
    )
    model = build(problem)
    rng = np.random.default_rng(0)
    u = (model.expansion @ (1e-3 * rng.standard_normal(model.unknowns))).reshape(-1, 2)
    forces = EI * rng.standard_normal(len(model.ties))
    state = build_state(model, u, 0.7, (), forces)
    A, gradients = dense_hessian(model, state)
    x = rng.standard_normal(model.unknowns)
    moved = build_state(model, u + 1j * STEP * (model.expansion @ x).reshape(-1, 2), 0.7, (), forces)
    change = model.restriction @ residual(model, moved).imag.ravel() / STEP
    np.testing.assert_allclose(change, A @ x, rtol=0, atol=1e-12 * np.abs(change).max())
    tangent = linearise(model, state)
    R = model.restriction @ residual(model, state).ravel()
    step = tangent.correction(R)
    G, C = np.stack(gradients, 1), np.diag([tie.flexibility for tie in model.ties])
    bordered = np.block([[A, -G], [G.T, C]])
    full = np.linalg.solve(bordered, -np.concatenate([R, tie_residuals(model, state)]))
    np.testing.assert_allclose(step.forces, full[model.unknowns :], rtol=1e-6)
    flexible = np.diag(C) > 0
    springs = G[:, flexible] / np.diag(C)[flexible] @ G[:, flexible].T
    Z = np.linalg.svd(G[:, ~flexible].T)[2][(~flexible).sum() :].T
    assert tangent.index() == (np.linalg.eigvalsh(Z.T @ (A + springs) @ Z) < 0).sum()


@pytest.mark.parametrize(
    ("make", "rule"),
    [
        (lambda: fr.LineLoad(strip="s", force=((0.0, 0.0),)), "force = .*must not be zero"),
        (lambda: fr.LineLoad(strip="s", force=((0.0, 1.0),), part=(0.5, 0.5)), "must be two increasing"),
        (lambda: fr.PointLoad(strip="s", at=1.0, force=(0.0, 1.0)), "at = 1.0: must lie between 0 and 1"),
        (lambda: fr.PointLoad(strip="s", at=0.5), "force = .*must not be zero without a moment"),
        (lambda: fr.Spring(strip="s", end="end", stiffness=(-1.0, 0.0, 0.0)), "must be three finite values"),
        (
            lambda: fr.Joint(ends=("a.end", "b.end"), hinged=("a.end",)),
            "hinged = .*must be different ends among",
        ),
        (lambda: make_strip(end_height=0.0), "end_height = 0.0: must be"),
        (
            lambda: fr.SolidProblem(
                strips=(make_strip(),), inner_loads=(fr.PointLoad(strip="s", at=0.5, force=(1.0, 0.0)),)
            ),
            "strip = 's': must name a strip",
        ),
        (
            lambda: fr.SolidProblem(
                strips=(
                    make_strip(name="a", end=(0.5, 0.0), clamped=()),
                    make_strip(name="b", start=(0.5, 0.0), clamped=()),
                ),
                joints=(fr.Joint(ends=("a.end", "b.start"), hinged=("b.start",)),),
                supports=(
                    fr.Support(strip="a", end="start", motion=(0.0, 0.0, None)),
                    fr.Support(strip="b", end="end", motion=(None, 0.0, None)),
                ),
            ),
            "must hold a, b",
        ),
    ],
)
def test_mistakes_cost_one_line(make, rule):
    with pytest.raises(ValueError, match=rule) as caught:
        make()
    assert len(str(caught.value).splitlines()) == 1
