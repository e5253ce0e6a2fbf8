"""The balance of forces and moments on the whole structure, from a response and its scene alone."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from comparisons.answer import Array, Ints, Response
from comparisons.answer.axis import place_of
from comparisons.answer.round_off import force_round_off, least_force, residual_force
from comparisons.referee.path import SAME
from comparisons.referee.rod import largest
from comparisons.referee.state import Equilibrium
from comparisons.scene import BeamSpec, Scene

BALANCE = 1e-6
"""Largest unbalanced force of a model of this package, over the largest force that acts. Newton's tolerances are far below."""

_FEWEST = 8
"""Fewest load parameters up to which the work is compared with the strain energy."""
_NODES, _OWN = np.polynomial.legendre.leggauss(4)
_PARTS = ((np.arange(20)[:, None] + (_NODES + 1.0) / 2.0) / 20).ravel()
_WEIGHTS = np.tile(_OWN / 2.0, 20) / 20
"""Quadrature of a load along a beam, in twenty panels."""


class Action(NamedTuple):
    """A force on the structure, and the way of its point."""

    force: Array  #: Force (s, 2).
    place: Array  #: Places (s + 1, 2) of the point, rest first.
    couple: Array | float = 0.0  #: Free moment (s,).
    angle: Array | None = None  #: Rotation (s + 1,) of the point where the scene prescribes it.

    def moment(self, origin: Array) -> Array:
        """Return the moment (s,) about a point, with the free one."""
        x, y = (self.place[1:] - origin).T
        return np.asarray(self.couple + x * self.force[:, 1] - y * self.force[:, 0])

    def work(self, chosen: Ints) -> Array:
        """Return the work between the chosen states, 0 the one at rest, where forces change linearly with the place."""
        force = np.vstack([np.zeros(2), self.force])[chosen]
        work = ((force[1:] + force[:-1]) / 2.0 * np.diff(self.place[chosen], axis=0)).sum(axis=1)
        if self.angle is not None:
            moment = np.append(0.0, self.couple)[chosen]
            work += (moment[1:] + moment[:-1]) / 2.0 * np.diff(self.angle[chosen])
        return np.asarray(work)


def balance_failures(response: Response, scene: Scene, allowed: float = BALANCE) -> Iterator[str]:
    """Yield a sentence for forces that do not balance, and one for moments; contacts between beams are internal forces.

    ``sum R + sum F + sum P = 0`` and ``sum (M + x_R x R) + sum x_F x F + sum (m + x_P x P) = 0`` with the supports' and springs' R and M,
    the pins' forces F and the dead loads P and m, up to `allowed` of the largest force. The forces of springs follow from the positions;
    without the moment of a spring that has one, moments are not compared. Where a single pin pushes, the force that balances all others
    is compared with the stated contact force by its magnitude.
    """
    springs, others = _acting(response, scene)
    actions, origin = [*springs, *others], np.array(scene.beams[0].start)
    force = _sum(response, actions)
    pushing, magnitude, pins = _pins(response, scene, force)
    moments = [item.moment(origin) for item in actions]
    whole_moment = np.sum([0.0 * magnitude, *moments, *(item.moment(origin) for item in pins)], axis=0)
    length = max(beam.length for beam in scene.beams)
    # a least value keeps the solvers' residuals within balance where nothing acts
    forces = [*(item.force for item in actions), *(moment / length for moment in moments)]
    size = max([least_force(scene), *map(largest, (magnitude, *forces))])
    # a sum of forces has the residuals of all nodes of a beam
    residual = residual_force(scene) * max(beam.divisions for beam in scene.beams)
    scale = allowed * size + max(force_round_off(scene, size), residual, response.round_off)
    off = np.where(
        pushing <= 1, np.abs(np.hypot(*force.T) - magnitude), np.hypot(*_sum(response, [*actions, *pins]).T)
    )
    unknown = any(spring.rotation and spring.node not in response.springs for spring in scene.springs)
    for what, failed in (
        ("reactions", ~(off <= scale)),
        ("moments", (not unknown) & ~(np.abs(whole_moment) <= scale * length)),
    ):
        if failed.any():
            t = response.load_parameter[np.argmax(failed)]
            yield f"the support {what} do not balance contact forces and loads at load parameter {t:.6g}"


def unpaid(
    response: Response, scene: Scene, found: Mapping[int, Equilibrium], allowed: float
) -> Iterator[str]:
    """Yield the first load parameter of `found` at which the stated forces have not done the work that is the exact strain energy.

    ``W = sum int F dx + sum int M dtheta`` by the trapezoidal rule. Its error is bounded by three times the differences from the rule with
    every second load parameter, and by the work of a first interval without a partner. It is not bounded by few load parameters, by
    forces that are largest at the first of them, over the end of a stage, or over a corner of a pin's path between load parameters;
    a jump releases energy, friction dissipates it, and the rotation of a moment's end is not stated.
    """
    rubbed = any(spec.friction for spec in scene.contacts)
    turned = any(any(history.at(t)[2] for t in scene.times) for history in scene.load_histories)
    if response.events is None or rubbed or turned or scene.stages or len(response.load_parameter) < _FEWEST:
        return
    unknown = [event.load_parameter for event in response.events if event.released]
    corners = (t for pin in scene.pins for t in pin.corners)
    unknown += [t for t in corners if np.abs(response.load_parameter - t).min() > SAME]
    springs, actions = _acting(response, scene)
    outer = _sum(response, [*springs, *actions])
    if outer.any() and np.argmax(np.hypot(*outer.T)) == 0:
        return
    actions += _pins(response, scene, outer)[2]
    least = least_force(scene) * max(beam.length for beam in scene.beams)
    for k, exact in found.items():
        if k + 1 < _FEWEST or any(t <= response.load_parameter[k] for t in unknown):
            continue
        states, second = np.arange(k + 2), np.array([0, *range(1 + k % 2, k + 2, 2)])
        fine, coarse = (np.sum([item.work(x) for item in actions], axis=0) for x in (states, second))
        pairs = np.diff(np.append(0.0, np.cumsum(fine))[second])
        error = 3.0 * np.abs(pairs - coarse).sum() + (abs(fine[0]) if k % 2 == 0 else 0.0)
        missing, most = abs(np.sum(fine) - exact.strain_energy), max(np.abs(fine).sum(), least)
        if not missing <= allowed * most + error:
            yield (
                f"the work of supports, pins and loads is not the strain energy at load parameter {response.load_parameter[k]:.6g}, "
                f"off by {missing / most:.2g}"
            )
            return


def _sum(response: Response, actions: list[Action]) -> Array:
    """Return the sum of the forces (s, 2)."""
    nothing = np.zeros((len(response.load_parameter), 2))
    return np.asarray(np.sum([nothing, *(item.force for item in actions)], axis=0))


def _places(response: Response, scene: Scene, node: str) -> Array:
    """Places (s + 1, 2) of a beam's end, rest first: prescribed if its support holds it, else as the response states it."""
    (beam, end), motion = node.split("."), scene.prescribed_motions.get(node)
    if motion and None not in motion.at(0.0)[:2]:
        moved = [motion.at(t)[:2] for t in (0.0, *response.load_parameter.tolist())]
        return scene.place(node) + np.array(moved, dtype=np.float64)
    if end == scene.tip(beam):
        return np.vstack([scene.place(node), response.tips[beam]])
    return _ways(response, scene, node)


def _ways(response: Response, scene: Scene, node: str) -> Array:
    """Places (s + 1, 2) of a node, rest first, as the response states them."""
    return np.array([place_of(response, scene, node, k) for k in range(-1, len(response.load_parameter))])


def _acting(response: Response, scene: Scene) -> tuple[list[Action], list[Action]]:
    """Return the springs; supports, dead loads and weights, those along a beam and inside it on the axis that the response states."""
    times, springs, actions = response.load_parameter.tolist(), [], list[Action]()
    for spring in scene.springs:
        places, own = _places(response, scene, spring.node), response.springs.get(spring.node)
        force = -np.array(spring.stiffness) * (places[1:] - places[0])
        springs.append(Action(force, places, own.moment if own else 0.0))
    for node, held in response.supports.items():
        motion = scene.prescribed_motions.get(node)
        turn = np.array([motion.at(t)[2] or 0.0 for t in (0.0, *times)]) if motion else None
        actions.append(Action(held.force, _places(response, scene, node), held.moment, turn))
    for history in scene.load_histories:
        load, beam = history.load, scene.beam(history.load.beam)
        acting, (first, last) = np.array([history.at(t) for t in times]).reshape(-1, 3), load.span
        if load.force_per_length is not None:
            parts, extents = first + (last - first) * _PARTS, (last - first) * beam.length * _WEIGHTS
            actions.append(_inside(response, beam, parts, extents, acting))
        elif load.at is not None:
            actions.append(_inside(response, beam, np.array([load.at]), np.ones(1), acting))
        else:
            actions.append(Action(acting[:, :2], _places(response, scene, load.node), acting[:, 2]))
    gravity = np.array([(*scene.gravity_at(t), 0.0) for t in times]).reshape(-1, 3)
    for beam in scene.beams:
        if beam.density is not None:
            masses = beam.length * _WEIGHTS * [beam.mass_per_length(part) for part in _PARTS]
            actions.append(_inside(response, beam, _PARTS, masses, gravity))
    return springs, actions


def _inside(response: Response, beam: BeamSpec, parts: Array, weights: Array, acting: Array) -> Action:
    """Action of forces and moments (s, 3) times `weights` at parts of a beam's length, by cubic splines through the points of its axis."""
    from scipy.interpolate import CubicSpline

    lines = [response.axis_line(beam.name, k) for k in range(len(response.load_parameter))]
    places = [CubicSpline(arc, line)(parts * beam.length) for arc, line in lines]
    ways = np.array([[beam.place(part) for part in parts], *places])
    centre = np.average(ways, axis=1, weights=weights)
    return Action(acting[:, :2] * weights.sum(), centre, acting[:, 2] * weights.sum())


def _pins(response: Response, scene: Scene, outer: Array) -> tuple[Ints, Array, list[Action]]:
    """Return the number of pins that push, the sum of their magnitudes, and their actions; a single pin balances the forces `outer`."""
    touching = [(spec, response.contacts[spec.pair]) for spec in scene.contacts if "." not in spec.node]
    forces = np.array([np.zeros(len(response.load_parameter)), *(item.force for _, item in touching)])
    pushing, actions = np.sum(forces > 0.0, axis=0), []
    for spec, history in touching:
        vector = np.full_like(outer, np.nan) if history.vector is None else history.vector
        force = np.where((pushing <= 1)[:, None], -outer, vector)
        force = np.where((history.force > 0.0)[:, None], force, 0.0)
        rolling: Array | float = 0.0
        if history.friction is not None:
            # the tangential force acts on the surface, a radius and a gap away from the pin's centre
            lever = scene.radius(spec) + np.where(history.force > 0.0, history.gap, 0.0)
            rolling = (1.0 if spec.side == "left" else -1.0) * lever * history.friction.tangential
        actions.append(Action(force, _ways(response, scene, spec.node), rolling))
    return pushing, forces.sum(axis=0), actions
