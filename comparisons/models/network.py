"""The response of a scene's exact rods, from the equilibria that the referee finds with its own equations."""

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from comparisons.models.options import ModelError
from comparisons.models.progress import Watch, unwatched
from comparisons.models.rod import ROD
from comparisons.models.tsm import TSM
from comparisons.referee import Equilibrium, Verdict, certify
from comparisons.response import (
    Array,
    ContactHistory,
    FrictionHistory,
    Response,
    Sections,
    SupportHistory,
)
from comparisons.response.axis import axis_grid
from comparisons.scene import Scene

POINTS = 401
"""Points of a deflected axis in pictures. The solution does not depend on this number."""
States = Sequence[Equilibrium]


def solve_network(scene: Scene, model: str, watch: Watch = unwatched) -> Response:
    """Return the exact equilibria of a scene's rods along the path that exact TSM elements follow.

    The referee starts from the TSM answer at every load parameter, solves its own equations, and judges stability, admissibility
    and the path in between. Load parameters, the gaps of open contacts and slip-offs are those of TSM; all other values are the
    referee's. The response ends before the first load parameter at which the verdict is not `Verdict.CERTIFIED`.

    Parameters
    ----------
    scene : Scene
        Any scene.
    model : str
        Name of the model in the response.
    watch : callable
        Receives every accepted step of TSM.

    Raises
    ------
    ModelError
        If the scene uses a key that the referee does not state.
    """
    unknown = ROD.unstated(scene)
    if unknown is not None:
        raise ModelError(unknown)
    began = perf_counter()
    followed = TSM.solve(scene, TSM.reference, watch)
    found = certify(followed, scene, at=range(len(followed.load_parameter)))
    states: list[Equilibrium] = []
    for item in found.judged:
        if item.verdict is not Verdict.CERTIFIED or item.exact is None:
            break
        states.append(item.exact)
    friction = _frictions(scene, followed, states)

    def axis_line(beam: str, k: int) -> tuple[Array, Array]:
        arc = np.linspace(0.0, scene.beam(beam).length, POINTS)
        return arc, states[k].shape(beam, arc).position

    sound = found.verdict in (Verdict.CERTIFIED, Verdict.NOT_JUDGED) or not found.judged
    return replace(
        followed,
        model=model,
        status=followed.status if sound else found.verdict.name,
        message=followed.message if sound else found.reason,
        completed=followed.completed and sound,
        load_parameter=followed.load_parameter[: len(states)],
        contacts={
            pair: replace(_contact(pair, history, states), friction=friction.get(pair))
            for pair, history in followed.contacts.items()
        },
        work=_work(friction, states),
        supports=_supports(scene, states),
        tips={
            beam.name: _rows([state.ends[f"{beam.name}.{scene.tip(beam.name)}"] for state in states], 2)
            for beam in scene.beams
        },
        newton_iterations=np.array([state.iterations for state in states], dtype=np.int64),
        cutbacks=0,
        unknowns=max((len(state.solution.z) for state in states), default=0),
        axis_line=axis_line,
        grid=lambda k: axis_grid(scene, axis_line, k),
        events=None,
        integration_error=0.0,
        deformation=None,
        sections=lambda beam, k: _sections(scene, beam, states[k]),
        index=np.array([state.index for state in states], dtype=np.int64),
        wall_seconds=perf_counter() - began,
    )


def _rows(rows: Sequence[Array], width: int) -> Array:
    return np.array(rows, dtype=np.float64).reshape(-1, width)


def _contact(pair: str, followed: ContactHistory, states: States) -> ContactHistory:
    closed = [state.contacts.get(pair) for state in states]
    forces = _rows([np.zeros(2) if here is None else here.force for here in closed], 2)
    return replace(
        followed,
        force=np.hypot(*forces.T),
        arc_position=np.array([np.nan if here is None else here.arc_position for here in closed]),
        gap=np.array([gap if here is None else 0.0 for gap, here in zip(followed.gap, closed, strict=False)]),
        vector=forces,
    )


def _frictions(scene: Scene, followed: Response, states: States) -> dict[str, FrictionHistory]:
    """Forces, states and dissipation of the contacts with friction, by pair."""
    pairs = [spec.pair for spec in scene.contacts if spec.friction]
    if not pairs:
        return {}
    from comparisons.referee.friction import History, dissipated

    history = History(followed, scene)
    spent = [dissipated(history, k, state) for k, state in enumerate(states)]
    found = {}
    for pair in pairs:
        closed = [state.contacts.get(pair) for state in states]
        stated = followed.contacts[pair].friction
        assert stated is not None, "beams state their friction"
        found[pair] = FrictionHistory(
            tangential=np.array([0.0 if here is None else here.drag for here in closed]),
            normal=np.array([0.0 if here is None else here.push for here in closed]),
            slip=stated.slip[: len(states)],
            dissipated=np.cumsum([part[pair] for part in spent]),
        )
    return found


def _work(friction: dict[str, FrictionHistory], states: States) -> Array | None:
    """Work of pins, supports and loads, the sum of strain energy and dissipation; None where a node slipped off, or without friction."""
    work = np.array([state.strain_energy for state in states])
    work = work + sum(item.dissipated for item in friction.values())
    return work if friction and np.all(np.isfinite(work)) else None


def _supports(scene: Scene, states: States) -> dict[str, SupportHistory]:
    """Reactions by supported end."""
    tables = {
        item.node: _rows([state.reactions[item.node] for state in states], 3) for item in scene.all_supports
    }
    return {node: SupportHistory(force=table[:, :2], moment=table[:, 2]) for node, table in tables.items()}


def _sections(scene: Scene, beam: str, state: Equilibrium) -> Sections:
    """Return the section forces, from both sides of the contacts, where they jump."""
    length, pairs = scene.beam(beam).length, [spec.pair for spec in scene.contacts if spec.beam == beam]
    jumps = [state.contacts[pair].arc_position for pair in pairs if pair in state.contacts]
    sides = [np.nextafter(arc, side) for arc in jumps for side in (0.0, length)]
    arc = np.unique(np.concatenate([np.linspace(0.0, length, POINTS), sides]))
    shape = state.shape(beam, arc)
    return Sections(arc=arc, N=shape.N, V=shape.Q, M=shape.moment)
