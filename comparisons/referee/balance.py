"""The balance of forces and moments on the whole structure, from a response and its scene alone."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.response import Array, Response
from comparisons.response.round_off import force_round_off, least_force
from comparisons.scene import BeamSpec, Scene

BALANCE = 1e-6
"""Largest unbalanced force of a model of this package, over the largest force that acts. Newton's tolerances are far below."""

_FEWEST = 8
"""Fewest load parameters up to which the work is compared with the strain energy."""
_PANELS, _NODES = 20, 4
"""Panels, and nodes in each, of the quadrature of a load along a beam."""


class Action(NamedTuple):
    """A force (s, 2) on the structure and its moment (s,) about the start of the first beam, with any free moment added.

    Its point moves along `place` (s + 1, 2), rest first, and turns by `angle` (s + 1,) where the scene prescribes that.
    """

    force: Array
    moment: Array
    place: Array
    free: Array
    angle: Array | None

    def work(self, chosen: NDArray[np.int64]) -> Array:
        """Return the work between the chosen states, 0 the one at rest, where forces change linearly with the place."""
        force = np.vstack([np.zeros(2), self.force])[chosen]
        work = ((force[1:] + force[:-1]) / 2.0 * np.diff(self.place[chosen], axis=0)).sum(axis=1)
        if self.angle is not None:
            moment = np.concatenate([[0.0], self.free])[chosen]
            work += (moment[1:] + moment[:-1]) / 2.0 * np.diff(self.angle[chosen])
        return np.asarray(work)


def balance_failures(response: Response, scene: Scene, allowed: float = BALANCE) -> Iterator[str]:
    """Yield a sentence for forces that do not balance, and one for moments; contacts between beams are internal forces.

    The largest imbalance over the largest force is `allowed`. The forces of springs follow from the positions; without the moment of a
    spring that has one, moments are not compared.

    ``sum R + sum F + sum P = 0`` and ``sum (M + x_R x R) + sum x_F x F + sum (m + x_P x P) = 0`` with the supports' and springs' R and M,
    the pins' forces F at the pins and the dead loads P and m. Where a single pin pushes, the force that balances all other forces
    is computed, and its magnitude is compared with the stated contact force. Its moment enters the balance of moments, with the moment
    ``-side (R + g) F_t`` of a stated tangential force about the centre of a pin of radius R at the gap g, side = 1 for a pin on the right.
    """
    actions = [*_supports(response, scene), *_springs(response, scene), *_loads(response, scene)]
    force, _ = _sum(actions, len(response.load_parameter))
    pushing, magnitude, pins = _pins(response, scene, force)
    whole, whole_moment = _sum([*actions, *pins], len(response.load_parameter))
    length = max(beam.length for beam in scene.beams)
    # a least value keeps the solvers' residuals within balance where nothing acts
    forces = [array for item in actions for array in (item.force, item.moment / length)]
    largest = max([least_force(scene), *(float(np.abs(x).max(initial=0.0)) for x in (magnitude, *forces))])
    scale = allowed * largest + max(force_round_off(scene, largest), response.round_off)
    off = np.where(pushing <= 1, np.abs(np.hypot(*force.T) - magnitude), np.hypot(*whole.T))
    unknown = any(spring.rotation and spring.node not in response.springs for spring in scene.springs)
    for what, failed in (
        ("reactions", ~(off <= scale)),
        ("moments", (not unknown) & ~(np.abs(whole_moment) <= scale * length)),
    ):
        if failed.any():
            t = response.load_parameter[np.argmax(failed)]
            yield f"the support {what} do not balance contact forces and loads at load parameter {t:.6g}"


def unpaid(response: Response, scene: Scene, energies: Mapping[int, float], allowed: float) -> Iterator[str]:
    """Yield the first load parameter of `energies` at which the stated forces have not done the work that is the exact strain energy.

    ``W = sum int F dx + sum int M dtheta`` of supports, pins and loads by the trapezoidal rule over all load parameters. Its error is bounded
    by three times the differences from the rule with every second one, pair by pair of intervals, and by the work of a first interval
    without a partner. It is not bounded by few load parameters or over the end of a stage; a jump releases energy, friction dissipates it,
    and the rotation of a moment's end is not stated: there is nothing to compare with then.
    """
    rubbed = any(spec.friction for spec in scene.contacts)
    turned = any(any(history.at(t)[2] for t in scene.times) for history in scene.load_histories)
    if response.events is None or rubbed or turned or scene.stages or len(response.load_parameter) < _FEWEST:
        return
    jumps = [event.load_parameter for event in response.events if event.released]
    actions = [*_supports(response, scene), *_loads(response, scene)]
    outer, _ = _sum([*actions, *_springs(response, scene)], len(response.load_parameter))
    actions += _pins(response, scene, outer)[2]
    least = least_force(scene) * max(beam.length for beam in scene.beams)
    for k, energy in energies.items():
        if k + 1 < _FEWEST or any(t <= response.load_parameter[k] for t in jumps):
            continue
        fine, coarse = (
            np.sum([item.work(np.array([0, *range(1 + k % step, k + 2, step)])) for item in actions], axis=0)
            for step in (1, 2)
        )
        pairs = np.add.reduceat(fine, np.arange(-(k % 2 == 0), len(fine), 2).clip(0))
        alone = abs(fine[0]) if k % 2 == 0 else 0.0
        error = 3.0 * np.abs(pairs - coarse).sum() + alone
        missing, largest = abs(np.sum(fine) - energy), max(np.abs(fine).sum(), least)
        if not missing <= allowed * largest + error:
            yield (
                f"the work of supports, pins and loads is not the strain energy at load parameter {response.load_parameter[k]:.6g}, "
                f"off by {missing / largest:.2g}"
            )
            return


def _sum(actions: list[Action], steps: int) -> tuple[Array, Array]:
    """Return the sums of the forces and of the moments."""
    force = np.sum([np.zeros((steps, 2)), *(item.force for item in actions)], axis=0)
    return force, np.sum([np.zeros(steps), *(item.moment for item in actions)], axis=0)


def _action(
    scene: Scene,
    force: Array,
    place: Array,
    rest: Sequence[float] | Array,
    moment: Array | float = 0.0,
    angle: Array | None = None,
) -> Action:
    x, y = (place - np.array(scene.beams[0].start)).T
    free = np.broadcast_to(moment, len(force))
    about = np.asarray(free + x * force[:, 1] - y * force[:, 0])
    return Action(force, about, np.vstack([rest, place]), free, angle)


def _place(response: Response, scene: Scene, node: str) -> Array:
    """Deformed position (s, 2) of a beam's end: prescribed if its support holds it, else as the response states it."""
    beam, end = node.split(".")
    for support in scene.supports_of(beam):
        if support.end == end and {"x", "y"}.issubset(support.held):
            motion = scene.prescribed_motions[node]
            moved = [motion.at(t)[:2] for t in response.load_parameter.tolist()]
            return np.asarray(np.array(scene.place(node)) + np.array(moved, dtype=np.float64).reshape(-1, 2))
    if end == scene.tip(beam):
        return response.tips[beam]
    lines = [response.axis_line(beam, k)[1] for k in range(len(response.load_parameter))]
    return np.array([line[0 if end == "start" else -1] for line in lines]).reshape(-1, 2)


def _supports(response: Response, scene: Scene) -> list[Action]:
    motions, times, actions = scene.prescribed_motions, response.load_parameter.tolist(), []
    for node, history in response.supports.items():
        turns = [motions[node].at(t)[2] for t in (0.0, *times)] if node in motions else []
        angle = np.array([turn or 0.0 for turn in turns]) if turns else None
        place = _place(response, scene, node)
        actions.append(_action(scene, history.force, place, scene.place(node), history.moment, angle))
    return actions


def _springs(response: Response, scene: Scene) -> list[Action]:
    actions = []
    for spring in scene.springs:
        place, own = _place(response, scene, spring.node), response.springs.get(spring.node)
        rest = scene.place(spring.node)
        force = -np.array(spring.stiffness) * (place - np.array(rest))
        actions.append(_action(scene, force, place, rest, 0.0 if own is None else own.moment))
    return actions


def _loads(response: Response, scene: Scene) -> list[Action]:
    """Return the dead loads and the weights; those along a beam and inside it act on the axis that the response states."""
    times, actions = response.load_parameter.tolist(), []
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    inside = ((np.arange(_PANELS)[:, None] + (nodes + 1.0) / 2.0) / _PANELS).ravel()
    weights = np.tile(weights / 2.0, _PANELS) / _PANELS
    for history in scene.load_histories:
        load, beam = history.load, scene.beam(history.load.beam)
        acting, (first, last) = np.array([history.at(t) for t in times]).reshape(-1, 3), load.span
        if load.force_per_length is not None:
            parts, extents = first + (last - first) * inside, (last - first) * beam.length * weights
            actions.append(_inside(response, scene, beam, parts, extents, acting * (1.0, 1.0, 0.0)))
        elif load.at is not None:
            actions.append(_inside(response, scene, beam, np.array([load.at]), np.ones(1), acting))
        else:
            place, rest = _place(response, scene, load.node), scene.place(load.node)
            actions.append(_action(scene, acting[:, :2], place, rest, acting[:, 2]))
    gravity = np.array([(*scene.gravity_at(t), 0.0) for t in times]).reshape(-1, 3)
    for beam in scene.beams:
        if beam.density is not None:
            masses = beam.length * weights * [beam.mass_per_length(part) for part in inside]
            actions.append(_inside(response, scene, beam, inside, masses, gravity))
    return actions


def _inside(
    response: Response, scene: Scene, beam: BeamSpec, parts: Array, weights: Array, acting: Array
) -> Action:
    """Action of forces and moments (s, 3) times `weights` at parts of a beam's length, by cubic splines through the points of its axis."""
    from scipy.interpolate import CubicSpline

    lines = [response.axis_line(beam.name, k) for k in range(len(response.load_parameter))]
    places = [CubicSpline(arc, line)(parts * beam.length) for arc, line in lines]
    centre = np.average(np.reshape(places, (-1, len(parts), 2)), axis=1, weights=weights)
    rest = np.average([beam.place(part) for part in parts], axis=0, weights=weights)
    return _action(scene, acting[:, :2] * weights.sum(), centre, rest, acting[:, 2] * weights.sum())


def _pins(response: Response, scene: Scene, outer: Array) -> tuple[NDArray[np.int64], Array, list[Action]]:
    """Return the number of pins that push, the sum of their magnitudes, and their actions; a single pin balances the forces `outer`."""
    touching = [(spec, response.contacts[spec.pair]) for spec in scene.contacts if "." not in spec.node]
    steps, actions = len(response.load_parameter), []
    pushing = np.sum([np.zeros(steps, dtype=np.int64), *(item.force > 0.0 for _, item in touching)], axis=0)
    magnitude = np.sum([np.zeros(steps), *(item.force for _, item in touching)], axis=0)
    for spec, history in touching:
        rest, *places = (scene.pin(spec.node).position(t) for t in (0.0, *response.load_parameter.tolist()))
        vector = np.full((steps, 2), np.nan) if history.vector is None else history.vector
        force = np.where((pushing <= 1)[:, None], -outer, vector)
        force = np.where((history.force > 0.0)[:, None], force, 0.0)
        rolling: Array | float = 0.0
        if history.friction is not None:
            # the tangential force acts on the surface, a radius and a gap away from the pin's centre
            lever = scene.radius(spec) + np.where(history.force > 0.0, history.gap, 0.0)
            rolling = (1.0 if spec.side == "left" else -1.0) * lever * history.friction.tangential
        actions.append(_action(scene, force, np.array(places), rest, rolling))
    return pushing, magnitude, actions
