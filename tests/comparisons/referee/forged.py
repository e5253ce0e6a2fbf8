"""Answers that are wrong in a known way, and exact ones stated as a model would state them."""

import numpy as np
from scipy.integrate import solve_ivp

from comparisons.referee import AnswerState, Equilibrium, SearchStatus, equilibrium
from comparisons.response import ContactHistory, Response, SupportHistory
from comparisons.scene import Scene

POINTS = 201


def integrated(
    scene: Scene, t: float, clamp: tuple[float, float, float], touches: list[tuple[str, float, np.ndarray]]
) -> AnswerState:
    """State of the first beam, clamped at its start along +x, from a reaction and contact forces at arc positions, by integration."""
    beam = scene.beams[0]
    n, state, begin = -np.array(clamp[:2]), [0.0, 0.0, 0.0, -clamp[2]], 0.0
    arc, line = np.linspace(0.0, beam.length, POINTS), []
    for end, force in [*((s, f) for _, s, f in touches), (beam.length, np.zeros(2))]:

        def rate(_: float, y: np.ndarray, n: np.ndarray = n) -> list[float]:
            c, s = np.cos(y[2]), np.sin(y[2])
            N, Q = n[0] * c + n[1] * s, n[1] * c - n[0] * s
            dx, dy = (1.0 + N / beam.EA) * c - Q / beam.GA * s, (1.0 + N / beam.EA) * s + Q / beam.GA * c
            return [dx, dy, y[3] / beam.EI, dy * n[0] - dx * n[1]]

        inside = arc[(arc >= begin) & (arc < end)]
        path = solve_ivp(rate, (begin, end), state, t_eval=np.append(inside, end), rtol=1e-9, atol=1e-12)
        line.append(path.y[:2, : len(inside)].T)
        state, begin, n = path.y[:, -1], end, n - force
    axis = np.vstack([*line, state[:2]]) + np.array(beam.start)
    return AnswerState(
        load_parameter=t,
        arcs={pair: s for pair, s, _ in touches},
        forces={pair: (float(f[0]), float(f[1])) for pair, _, f in touches},
        axes={beam.name: (arc, axis)},
        reactions={f"{beam.name}.start": clamp},
        tips={beam.name: (float(axis[-1, 0]), float(axis[-1, 1]))},
    )


def stated(scene: Scene, path: list[Equilibrium], model: str = "tsm") -> Response:
    """Return exact equilibria, one for each load parameter, as the answer of a model."""
    assert all(exact.status is SearchStatus.FOUND for exact in path)
    steps = len(path)
    contacts = {}
    for spec in scene.contacts:
        own = [exact.contacts.get(spec.pair) for exact in path]
        vector = np.array([[0.0, 0.0] if item is None else item.force for item in own])
        contacts[spec.pair] = ContactHistory(
            force=np.hypot(*vector.T),
            arc_position=np.array([np.nan if item is None else item.arc_position for item in own]),
            gap=np.zeros(steps),
            vector=vector,
        )
    supports = {}
    for item in scene.all_supports:
        table = np.array([exact.reactions[item.node] for exact in path])
        supports[item.node] = SupportHistory(force=table[:, :2], moment=table[:, 2])

    def axis_line(beam: str, k: int) -> tuple[np.ndarray, np.ndarray]:
        arc = np.linspace(0.0, scene.beam(beam).length, POINTS)
        return arc, path[k].shape(beam, arc).position

    return Response(
        model=model,
        scene=scene.name,
        status="COMPLETED",
        message="all load parameters were reached",
        completed=True,
        load_parameter=np.array([exact.load_parameter for exact in path]),
        contacts=contacts,
        supports=supports,
        tips={
            beam.name: np.array([exact.ends[f"{beam.name}.{scene.tip(beam.name)}"] for exact in path])
            for beam in scene.beams
        },
        newton_iterations=np.zeros(steps, dtype=np.int64),
        cutbacks=0,
        unknowns=0,
        wall_seconds=0.0,
        axis_line=axis_line,
        grid=lambda _: None,  # type: ignore[arg-type, return-value]
    )


def bent(scene: Scene, t: float, axes: dict[str, np.ndarray]) -> Equilibrium:
    """Return the equilibrium next to given axes, without contact."""
    arcs = {beam.name: np.linspace(0.0, beam.length, len(axes[beam.name])) for beam in scene.beams}
    given = AnswerState(
        load_parameter=t, arcs={}, forces={}, axes={name: (arcs[name], line) for name, line in axes.items()},
        reactions={}, tips={},
    )  # fmt: skip
    return equilibrium(scene, given)
