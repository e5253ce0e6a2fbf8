"""The response of a scene's exact rods, from the equilibria that the referee finds with its own equations."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import takewhile
from typing import Any

import numpy as np

from comparisons.answer import Array, ContactHistory, FrictionHistory, Response, Sections, SupportHistory
from comparisons.models.model import Watch
from comparisons.models.shared import POINTS, Axis, rows
from comparisons.models.tsm import TSM
from comparisons.referee import Equilibrium, Verdict, certify
from comparisons.scene import Scene

States = Sequence[Equilibrium]


def solve_rods(scene: Scene, watch: Watch) -> Response:
    """Return the exact equilibria of a scene's rods along the path that exact TSM elements follow.

    The referee starts from the TSM answer at every load parameter, solves its own equations, and judges stability, admissibility
    and the path in between. Load parameters, springs, the gaps of open contacts and slip-offs are those of TSM; all other values are the
    referee's. The response ends before the first load parameter at which the verdict is not `Verdict.CERTIFIED`. `watch` receives
    every accepted step of TSM.
    """
    followed = TSM.solve(scene, TSM.reference, watch)
    found = certify(followed, scene, at=range(len(followed.load_parameter)))
    judged = takewhile(
        lambda item: item.verdict is Verdict.CERTIFIED and item.exact is not None, found.judged
    )
    states = [item.exact for item in judged if item.exact is not None]
    spent = _dissipated(scene, followed, states)
    sound = found.verdict in (Verdict.CERTIFIED, Verdict.NOT_JUDGED) or not found.judged
    # work of pins, supports and loads is strain energy and dissipation, unknown where a node slipped off
    work = np.array([state.strain_energy for state in states]) + sum(spent.values())
    held = {
        node.node: rows([state.reactions[node.node] for state in states], 3) for node in scene.all_supports
    }
    reached = slice(len(states))

    def axis_line(beam: str, k: int) -> Axis:
        arc = np.linspace(0.0, scene.beam(beam).length, POINTS)
        return arc, states[k].shape(beam, arc).position

    return Response(
        status=followed.status if sound else found.verdict.name,
        message=followed.message if sound else found.reason,
        load_parameter=followed.load_parameter[reached],
        contacts={
            pair: _contact(pair, history, states, spent.get(pair, np.zeros(0)))
            for pair, history in followed.contacts.items()
        },
        work=work if spent and np.all(np.isfinite(work)) else None,
        supports={
            node: SupportHistory(force=table[:, :2], moment=table[:, 2]) for node, table in held.items()
        },
        springs={
            node: SupportHistory(force=one.force[reached], moment=one.moment[reached])
            for node, one in followed.springs.items()
        },
        tips={
            beam.name: rows([state.ends[f"{beam.name}.{scene.tip(beam.name)}"] for state in states], 2)
            for beam in scene.beams
        },
        newton_iterations=np.array([state.iterations for state in states], dtype=np.int64),
        unknowns=max((len(state.z) for state in states), default=0),
        axis_line=axis_line,
        critical=followed.critical,
        sections=lambda beam, k: _sections(scene, beam, states[k]),
        index=np.array([state.index for state in states], dtype=np.int64),
    )


def _contact(pair: str, followed: ContactHistory, states: States, spent: Array) -> ContactHistory:
    """Return the contact of the referee's equilibria; the gaps of open ones and the senses of slips are those of TSM."""
    closed, friction = [state.contacts.get(pair) for state in states], followed.friction

    def found(name: str, if_open: Any = 0.0) -> Array:
        return np.array([if_open if here is None else getattr(here, name) for here in closed])

    forces, arcs = rows(found("force", (0.0, 0.0)), 2), found("arc_position", np.nan)
    if friction is not None:
        sense = friction.slip[: len(states)]
        friction = FrictionHistory(
            tangential=found("drag"), normal=found("push"), slip=sense, dissipated=spent
        )
    return replace(
        followed,
        force=np.hypot(*forces.T),
        arc_position=arcs,
        gap=np.where(np.isnan(arcs), followed.gap[: len(states)], 0.0),
        vector=forces,
        friction=friction,
    )


def _dissipated(scene: Scene, followed: Response, states: States) -> dict[str, Array]:
    """Energies (s,) that the contacts with friction have dissipated, by pair."""
    pairs = [spec.pair for spec in scene.contacts if spec.friction]
    if not pairs:
        return {}
    from comparisons.referee.friction import History, dissipated

    history = History(followed, scene)
    parts = [dissipated(history, k, state) for k, state in enumerate(states)]
    return {pair: np.cumsum([part[pair] for part in parts]) for pair in pairs}


def _sections(scene: Scene, beam: str, state: Equilibrium) -> Sections:
    """Return the section forces, from both sides of the contacts, where they jump."""
    length, pairs = scene.beam(beam).length, [spec.pair for spec in scene.contacts if spec.beam == beam]
    jumps = [state.contacts[pair].arc_position for pair in pairs if pair in state.contacts]
    sides = [np.nextafter(arc, side) for arc in jumps for side in (0.0, length)]
    arc = np.unique(np.concatenate([np.linspace(0.0, length, POINTS), sides]))
    shape = state.shape(beam, arc)
    return Sections(arc=arc, N=shape.N, V=shape.Q, M=shape.moment)
