"""The exact values that the manual states are computed anew by oracles, which share nothing with the models."""

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np
import pytest

from comparisons.claims.manual.friction import COEFFICIENTS, KS_PATH

# the table of problems, whose stated digits are the subject
from comparisons.claims.manual.problems import PROBLEMS
from comparisons.claims.problems.double_beam import HAND_OVER
from comparisons.exact import FrictionPath, rod_with_friction
from comparisons.scene import BeamSpec, load_scene
from tests.oracles import elastica, frames
from tests.oracles.coupled import pair_of
from tests.oracles.friction import elastica_with_friction
from tests.oracles.tied import rod_with_tied_tip


def column() -> tuple[float, float]:
    """Place of the head of the clamped column over its length."""
    x, y, _ = elastica.tip_under_thrust(80.0 / 17.5, 0.08 / 17.5)
    return float(x), float(y)


def tied() -> list[float]:
    """Force on the tip half way and at the end, and moment of the clamp at the end."""
    beam = load_scene("ks-tied-tip").beams[0]
    points = [(1.0, 0.0), (0.5, 1.0 / np.pi), (0.0, 2.0 / np.pi)]
    path = rod_with_tied_tip(points, EA=beam.EA / beam.EI, GA=beam.GA / beam.EI, EI=1.0)
    return [*np.hypot(*path.force[1:].T), path.clamp_moment[-1]]


def pair() -> list[float]:
    """Forces at the depth .31 m, and the depths of the events."""
    both = pair_of(load_scene("double-beam"))
    stage = both.stage([0.31])
    forces = np.hypot(*stage.pin_force[0]), np.hypot(*stage.tip_force[0])
    return [*forces, stage.touch_depth, stage.end_depth, both.slip_off()]


def flat(rows: Iterable[Iterable[float]]) -> list[float]:
    """Return the numbers of all rows."""
    return [value for row in rows for value in row]


def rubbing(beam: BeamSpec, points: Sequence[tuple[float, float]], friction: float) -> FrictionPath:
    """Return the exact rod with friction, which the product has too."""
    return rod_with_friction(
        points, friction=friction, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length
    )


def rubbing_rods() -> Iterator[tuple[float, ...]]:
    """Yield force, arc position, moment of the clamp and dissipation at the end of the KS path."""
    for mu in COEFFICIENTS:
        path = rubbing(load_scene("ks-friction").beams[0], KS_PATH, mu)
        yield path.magnitude[-1], path.arc_position[-1], path.clamp_moment[-1], path.dissipated[-1]


def rubbing_elastica() -> Iterator[tuple[float, ...]]:
    """Yield force and arc position at the end of the KS path, and the load parameters of stick and slip."""
    for mu in COEFFICIENTS:
        path = elastica_with_friction(KS_PATH, friction=mu)
        yield path.magnitude[-1], path.arc_position[-1], *(event.load_parameter for event in path.events[1:])


def hysteresis() -> list[float]:
    """Forces, arc positions and dissipation of the second cycle, and what is 1 for any material."""
    scene = load_scene("hysteresis")
    path = rubbing(scene.beams[0], scene.pins[0].points, scene.contacts[0].friction)
    F, s, spent, work = path.magnitude, path.arc_position, path.dissipated, path.work
    lost = spent[5] - spent[3]
    return [*F[4:], *s[4:], lost, F[4] / F[2], F[5] / F[3], (work[5] - work[3]) / lost]


ORACLES: dict[str, Callable[[], Iterable[float]]] = {
    "dead-load": lambda: [elastica.tip_under_dead_load(load)[1] for load in (1.0, 2.0, 5.0, 10.0)],
    "clamped-column": lambda: [column()[0], -column()[1], -8.0 - 8000.0 * column()[1]],
    "pinned-column": lambda: [column()[0], column()[1] / 2.0],
    "lees-frame": lambda: [frames.lee_limit()],
    "williams-toggle": frames.toggle_limits,
    "portal-frame": lambda: [frames.portal_sway()],
    "ks-tied-tip": tied,
    "double-beam": pair,
    "force-limit": elastica.contact_force_limit,
    "three-point-bending": lambda: np.array(elastica.three_point_limit()[0]) * [2.0, 1.0],
    "slip-off": lambda: [elastica.slip_off_height(0.8)],
    "three-point-friction": lambda: flat(elastica.three_point_limit(0.2)),
    "ks-friction-elastica": lambda: flat(rubbing_elastica()),
    "ks-friction": lambda: flat(rubbing_rods()),
    "hysteresis": hysteresis,
}
"""The exact values of problems, in order."""


@pytest.mark.slow_at("hysteresis", "ks-friction")
@pytest.mark.parametrize("name", ORACLES)
def test_an_oracle_has_the_values_of_the_manual(name: str) -> None:
    problem = PROBLEMS[name]()
    for quantity, value in zip(problem.quantities, ORACLES[name](), strict=True):
        scale = abs(quantity.exact) if quantity.scale is None else quantity.scale
        assert abs(value - quantity.exact) <= problem.uncertainty * scale, quantity.name


def test_the_pin_is_handed_over_wherever_it_comes_down() -> None:
    for place, depth in HAND_OVER.items():
        assert pair_of(load_scene("double-beam"), place).stage([]).end_depth == pytest.approx(
            depth, rel=1e-10
        )
