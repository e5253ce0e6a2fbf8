"""The referee against shooting with Taylor series and 30 digits on four scenes; nothing of it is the referee's or the suite's own."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from mpmath import cos, lu_solve, matrix, mp, mpf, sin

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import Equilibrium, SearchStatus, answer_state, equilibrium
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene

mp.dps = 30
ORDER, STEPS = 30, 8


def ahead(state: list, n: tuple, stiffness: tuple, length: mpf) -> list:
    """State ``x, y, theta, m`` after a part of a rod with the force n: ``theta' = m/EI``, ``m' = -r' x n``, by Taylor series."""
    EI, EA, GA = stiffness
    h = length / STEPS
    for _ in range(STEPS):
        x, y, th, m = ([value] for value in state)
        c, s = [cos(th[0])], [sin(th[0])]
        N, Q, turn = [], [], []

        def times(a: list, b: list, k: int) -> mpf:
            return mp.fdot(a[: k + 1], b[k::-1])

        for k in range(ORDER):
            N.append((n[0] * c[k] + n[1] * s[k]) / EA)
            Q.append((n[1] * c[k] - n[0] * s[k]) / GA)
            dx = c[k] + times(N, c, k) - times(Q, s, k)
            dy = s[k] + times(N, s, k) + times(Q, c, k)
            x.append(dx / (k + 1))
            y.append(dy / (k + 1))
            m.append((dy * n[0] - dx * n[1]) / (k + 1))
            turn.append(m[k] / EI)
            th.append(turn[k] / (k + 1))
            c.append(-mp.fdot(turn, s[k::-1]) / (k + 1))
            s.append(mp.fdot(turn, c[k::-1]) / (k + 1))
        state = [mp.polyval(series[::-1], h) for series in (x, y, th, m)]
    return state


def tangent(theta: mpf, n: tuple, stiffness: tuple) -> tuple:
    _, EA, GA = stiffness
    c, s = cos(theta), sin(theta)
    N, Q = (n[0] * c + n[1] * s) / EA, (n[1] * c - n[0] * s) / GA
    return (1 + N) * c - Q * s, (1 + N) * s + Q * c


def misses(z: list, scene: Scene, pairs: list, t: mpf) -> tuple[list, list]:
    """What the equations miss at ``n_x, n_y, m_0`` and ``s, F_x, F_y`` of each contact, and the tip: a clamped beam along +x."""
    beam = scene.beams[0]
    stiffness = mpf(beam.EI), mpf(beam.EA), mpf(beam.GA)
    state, n, at, missed = [mpf(0), mpf(0), mpf(0), z[2]], (z[0], z[1]), mpf(0), []
    for k, spec in enumerate(pairs):
        s, fx, fy = z[3 + 3 * k : 6 + 3 * k]
        state, at = ahead(state, n, stiffness, s - at), s
        behind = (n[0] - fx, n[1] - fy)
        mean = [
            a + b
            for a, b in zip(
                tangent(state[2], n, stiffness), tangent(state[2], behind, stiffness), strict=True
            )
        ]
        size = mp.hypot(*mean)
        offset = mpf(scene.offset(spec)) * (1 if spec.side == "left" else -1) / size
        px, py = scene.pin(spec.node).position(float(t))
        missed += [
            state[0] - offset * mean[1] - px,
            state[1] + offset * mean[0] - py,
            fx * mean[0] + fy * mean[1],
        ]
        n = behind
    state = ahead(state, n, stiffness, mpf(beam.length) - at)
    load = next((item for item in scene.loads), None)
    support = next((item for item in scene.supports), None)
    if support is not None:
        ux, uy = support.displacement
        missed += [state[0] - beam.length - t * mpf(ux), state[1] - t * mpf(uy), state[3]]
    else:
        px, py, moment = (*load.force, load.moment) if load else (0, 0, 0)
        missed += [n[0] - t * mpf(px), n[1] - t * mpf(py), state[3] - t * mpf(moment)]
    return missed, state


def shoot(exact: Equilibrium, scene: Scene) -> tuple[list, list]:
    """One step of Newton's method with differences from the referee's answer, to 22 digits."""
    pairs = sorted(
        (spec for spec in scene.contacts if spec.pair in exact.contacts),
        key=lambda spec: exact.contacts[spec.pair].arc_position,
    )
    clamp, t = exact.reactions[f"{scene.beams[0].name}.start"], mpf(exact.load_parameter)
    z = [mpf(-clamp[0]), mpf(-clamp[1]), mpf(-clamp[2])]
    for spec in pairs:
        here = exact.contacts[spec.pair]
        z += [mpf(here.arc_position), mpf(here.force[0]), mpf(here.force[1])]
    scales = [max(abs(value), mpf("1e-12")) for value in z]
    missed, _ = misses(z, scene, pairs, t)
    step, jacobian = mpf("1e-14"), matrix(len(z), len(z))
    for k, scale in enumerate(scales):
        other, _ = misses([v + (step * scale if i == k else 0) for i, v in enumerate(z)], scene, pairs, t)
        for row, (a, b) in enumerate(zip(other, missed, strict=True)):
            jacobian[row, k] = (a - b) / (step * scale)
    change = lu_solve(jacobian, -matrix(missed))
    z = [value + change[k] for k, value in enumerate(z)]
    missed, state = misses(z, scene, pairs, t)
    assert max(map(abs, missed)) < 1e-22 * max(scales)
    return z, state


def under_a_face() -> Scene:
    return replace(load_scene("ks-face"), load_parameters=4)


def two_pins() -> Scene:
    """Two thick pins on both sides of a thick beam: shear counts."""
    return Scene(
        name="two-pins",
        load_parameters=2,
        beams=(
            BeamSpec(
                name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=0.12, height=0.12,
                youngs_modulus=1e7, poissons_ratio=0.25,
            ),
        ),
        pins=(
            PinSpec(name="p", start=(0.4, -0.07), displacement=(0.05, 0.12), radius=0.01),
            PinSpec(name="q", start=(0.8, 0.06), displacement=(-0.1, -0.03)),
        ),
        contacts=(
            ContactSpec(node="p", beam="b", side="right", surface="face"),
            ContactSpec(node="q", beam="b", side="left", surface="face"),
        ),
    )  # fmt: skip


def strong_shear() -> Scene:
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=0.025, height=0.025,
        youngs_modulus=1e7, shear_modulus=1e4,
    )  # fmt: skip
    load = LoadSpec(beam="b", end="end", force=(0.7, -4.0), moment=0.3)
    return Scene(name="shear", load_parameters=4, beams=(beam,), loads=(load,))


def moved_tip() -> Scene:
    return replace(load_scene("ks-tied-tip"), load_parameters=4)


@pytest.mark.parametrize(
    "make",
    [
        strong_shear,
        *(pytest.param(make, marks=pytest.mark.slow) for make in (moved_tip, under_a_face, two_pins)),
    ],
)
def test_thirty_digits(make: Callable[[], Scene]) -> None:
    """Forces, arc positions and the tip to 1e-14 of the largest force, or of the length."""
    scene = make()
    answer = solve(scene, "tsm", Options(element="exact"))
    assert answer.completed, answer.message
    exact = equilibrium(scene, answer_state(answer, scene, -1))
    assert exact.status is SearchStatus.FOUND
    z, tip = shoot(exact, scene)
    clamp = exact.reactions[f"{scene.beams[0].name}.start"]
    size = max(float(abs(value)) for k, value in enumerate(z) if k < 2 or k % 3)
    errors = [abs(float(z[0] + mpf(clamp[0]))) / size, abs(float(z[1] + mpf(clamp[1]))) / size]
    errors.append(abs(float(z[2] + mpf(clamp[2]))) / size)
    contacts = sorted(exact.contacts.values(), key=lambda item: item.arc_position)
    for k, here in enumerate(contacts):
        s, fx, fy = z[3 + 3 * k : 6 + 3 * k]
        errors += [abs(float(s - mpf(here.arc_position)))]
        errors += [abs(float(fx - mpf(here.force[0]))) / size, abs(float(fy - mpf(here.force[1]))) / size]
    end = exact.ends[f"{scene.beams[0].name}.end"]
    errors += [abs(float(tip[k] - mpf(end[k]))) for k in range(2)]
    print(make.__name__, [f"{e:.1e}" for e in errors])
    assert max(errors) < 1e-14
