"""The exact values that the manual states are computed anew by oracles, which share nothing with the models."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from comparisons.exact import elastica_under_pin, rod_under_pin
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import load_scene
from comparisons.suites.manual import problems, read_problem

# not public: what a problem reads, of the exact rod
from comparisons.suites.manual.measures import Answers, readings
from comparisons.suites.paper.fig9 import HAND_OVER
from tests.oracles import elastica, frames
from tests.oracles.coupled import pair_of
from tests.oracles.friction import rubbed
from tests.oracles.shooting import tied as tied_by_shooting

PROBLEMS = {path.stem: read_problem(path) for path in problems()}
COEFFICIENTS, KS_PATH = (0.1, 0.3, 0.5), ((1.0, 0.0), (0.0, 2.0 / np.pi))
EULER, K2 = np.pi**2 / 4.0, float(ellipk(0.5))
X, Y, _ = elastica.tip_under_thrust(80.0 / 17.5, 0.08 / 17.5)
"""Place of the head of the clamped column over its length."""


def section(name):
    """Return the sizes of a scene's beam."""
    beam = load_scene(name).beams[0]
    return {key: getattr(beam, key) for key in ("EA", "GA", "EI", "length")}


def tied():
    """It begins near the rod's answer, which says the branch."""
    scene = replace(load_scene("ks-tied-tip"), load_parameters=2)
    (beam,), near = scene.beams, solve(scene, "rod").supports["cantilever.start"]
    unit = {"EA": beam.EA / beam.EI, "GA": beam.GA / beam.EI, "EI": 1.0}
    half, whole = (
        tied_by_shooting(tip, -np.array([near.moment[k], *near.force[k]]) / beam.EI * 1.001, **unit)
        for k, tip in enumerate(([0.5, 1.0 / np.pi], [0.0, 2.0 / np.pi]))
    )
    return [np.hypot(*half[1:]), np.hypot(*whole[1:]), -whole[0]]


def pair():
    both = pair_of(load_scene("double-beam"))
    stage = both.stage([0.31])
    forces = np.hypot(*stage.pin_force[0]), np.hypot(*stage.tip_force[0])
    return [*forces, stage.touch_depth, stage.end_depth, both.slip_off()]


def rubbing_rods():
    for mu in COEFFICIENTS:
        path = rod_under_pin(KS_PATH, friction=mu, **section("ks-friction"))
        yield from (path.magnitude[-1], path.arc_position[-1], path.clamp_moment[-1], path.dissipated[-1])


def rubbing_elastica():
    for mu in COEFFICIENTS:
        path = rubbed(mu)
        yield from (path.force, path.arc_position, path.stick, path.slip)


def hysteresis():
    scene = load_scene("hysteresis")
    given = {"friction": scene.contacts[0].friction, **section("hysteresis")}
    path = rod_under_pin(scene.pins[0].points, **given)
    F, s, spent, work = path.magnitude, path.arc_position, path.dissipated, path.work
    lost = spent[5] - spent[3]
    return [*F[4:], *s[4:], lost, F[4] / F[2], F[5] / F[3], (work[5] - work[3]) / lost]


def by_the_rod(name):
    """Values of one rod by collocation, of several by the referee; both share nothing with the models that are judged."""
    problem = PROBLEMS[name]
    return list(
        readings(Answers(problem=problem, trial=replace(problem.trials[0], model="rod", options=Options())))
    )


def elastica_of_ks():
    path = elastica_under_pin([(1.0 - t, t * 2.0 / np.pi) for t in (0.25, 0.5, 0.75, 1.0)])
    return [*path.magnitude, *path.arc_position, -np.pi]


def haringx():
    beam = PROBLEMS["haringx-column"].scene.beams[0]
    c = 1.0 / beam.GA - 1.0 / beam.EA
    return [(np.sqrt(1.0 + 4.0 * c * EULER) - 1.0) / (2.0 * c)]


def short():
    beam = PROBLEMS["short-cantilever"].scene.beams[0]
    force = 1e-5 / (0.8**3 / (3.0 * beam.EI) + 0.8 / beam.GA)
    return [force, -0.8 * force]


def plane_strain():
    scene, nu = PROBLEMS["locking"].scene, 0.4999
    (beam,) = scene.beams
    E = beam.youngs_modulus
    stiff = replace(
        beam, youngs_modulus=E / (1.0 - nu**2), poissons_ratio=None, shear_modulus=E / (2.0 + 2.0 * nu)
    )
    (contact,) = solve(replace(scene, beams=(stiff,)), "rod").contacts.values()
    return contact.force[-1], contact.arc_position[-1]


ORACLES: dict[str, Callable[[], Iterable[float]]] = {
    "dead-load": lambda: [elastica.tip_under_dead_load(load)[1] for load in (1.0, 2.0, 5.0, 10.0)],
    "clamped-column": lambda: [X, -Y, -8.0 - 8000.0 * Y],
    "pinned-column": lambda: [X, Y / 2.0],
    "lees-frame": lambda: [frames.lee_limit()],
    "williams-toggle": frames.toggle_limits,
    "portal-frame": lambda: [frames.portal_sway()],
    "ks-tied-tip": tied,
    "double-beam": pair,
    "force-limit": elastica.contact_force_limit,
    "three-point-bending": lambda: np.array(elastica.three_point_limit()[0]) * [2.0, 1.0],
    "slip-off": lambda: [elastica.slip_off_height(0.8)],
    "three-point-friction": lambda: np.ravel(elastica.three_point_limit(0.2)),
    "ks-friction-elastica": rubbing_elastica,
    "ks-friction": rubbing_rods,
    "hysteresis": hysteresis,
    "roll-up": lambda: [2.0 / np.pi, 2.0 / np.pi, 0.0],
    "euler-column": lambda: [EULER],
    "haringx-column": haringx,
    "post-buckling": lambda: [2.0 * float(ellipe(0.5)) / K2 - 1.0, 0.0],
    "short-cantilever": short,
    "ks-elastica": elastica_of_ks,
    "locking": plane_strain,
    "touch-again": lambda: [*by_the_rod("touch-again")[:4], 1.0 / 11.0, 5.0 / 11.0, 7.0 / 11.0],
    **{
        name: lambda name=name: by_the_rod(name)
        for name in (
            "ks-axis", "ks-face", "ks-biot", "slip-off-in-shear", "two-pins", "crossed-beams"
        )
    },
}  # fmt: skip
"""The exact values of problems, in order."""
BY_DEFINITION = {
    "elastica-identity": [1.0] * 3, "sleeve": [0.5] * 3, "mixed-order": [4.0], "timoshenko-order": [2.0], "thin-strips": [2.0],
    "penalty-slope": [-1.0], "energy-balance": [1.0], "objectivity": [0.0] * 2, "mirror": [0.0] * 2, "reversal": [0.0] * 2,
}  # fmt: skip
"""Identities and orders, which no program computes."""


DEAR = "hysteresis ks-friction ks-tied-tip crossed-beams ks-friction-elastica two-pins slip-off-in-shear williams-toggle"


@pytest.mark.slow_at(*DEAR.split())
@pytest.mark.parametrize("name", ORACLES)
def test_an_oracle_has_the_values_of_the_manual(name: str) -> None:
    problem = PROBLEMS[name]
    for quantity, value in zip(problem.quantities, ORACLES[name](), strict=True):
        scale = abs(quantity.exact) if quantity.scale is None else quantity.scale
        assert abs(value - quantity.exact) <= problem.uncertainty * scale, quantity.name


def test_the_pin_is_handed_over_wherever_it_comes_down() -> None:
    for place, depth in HAND_OVER.items():
        found = pair_of(load_scene("double-beam"), place).stage([]).end_depth
        assert found == pytest.approx(depth, rel=1e-10)


def test_every_digit_of_the_manual_has_a_second_source() -> None:
    assert {*ORACLES, *BY_DEFINITION} == set(PROBLEMS)
    for name, values in BY_DEFINITION.items():
        assert [quantity.exact for quantity in PROBLEMS[name].quantities] == values
