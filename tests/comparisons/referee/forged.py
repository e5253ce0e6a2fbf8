"""Answers that are wrong in a known way, and exact ones stated as a model would state them."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from comparisons.answer import ContactHistory, Deformation, Response, SupportHistory
from comparisons.referee import AnswerState, Equilibrium, SearchStatus, equilibrium
from comparisons.scene import Scene, load_scene

POINTS = 201


def scene_of(name: str, **changes: object) -> Scene:
    """Return a scene of `scenes`, with changes."""
    scene = load_scene(str(Path(__file__).parent / "scenes" / f"{name}.toml"))
    return replace(scene, **changes)  # type: ignore[arg-type]


def contact(response: Response, **changes: object) -> Response:
    """Return an answer whose only contact states something else."""
    ((pair, history),) = response.contacts.items()
    return replace(response, contacts={pair: replace(history, **changes)})  # type: ignore[arg-type]


def support(response: Response, **changes: object) -> Response:
    """Return an answer whose first support states something else."""
    node, history = next(iter(response.supports.items()))
    return replace(response, supports={**response.supports, node: replace(history, **changes)})  # type: ignore[arg-type]


def deformed(response: Response, t: float, *, turn: float = 0.0, strain: float = 0.0) -> Response:
    """Return an answer whose elements turn and strain so much at a load parameter, and bear a turn of 1."""
    at, turned, strained = (np.array([value]) for value in (t, turn, strain))
    return replace(
        response, deformation=Deformation(load_parameter=at, turn=turned, strain=strained, bearable=1.0)
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
        load_parameter=np.array([exact.load_parameter for exact in path]),
        contacts=contacts,
        supports=supports,
        tips={
            beam.name: np.array([exact.ends[f"{beam.name}.{scene.tip(beam.name)}"] for exact in path])
            for beam in scene.beams
        },
        axis_line=axis_line,
    )


def seen(
    scene: Scene, t: float = 1.0, axes: dict[str, np.ndarray] | None = None, **more: dict[str, object]
) -> AnswerState:
    """Return an answer with points of the beams' axes, undeformed ones by default, without contact unless `more` says."""
    parts, given = np.linspace(0.0, 1.0, 41), axes or {}
    lines = {
        beam.name: given.get(beam.name, np.array([beam.place(x) for x in parts])) for beam in scene.beams
    }
    arcs = {beam.name: np.linspace(0.0, beam.length, len(lines[beam.name])) for beam in scene.beams}
    return AnswerState(load_parameter=t, axes={name: (arcs[name], lines[name]) for name in lines}, **more)  # type: ignore[arg-type]


def bent(scene: Scene, t: float, axes: dict[str, np.ndarray]) -> Equilibrium:
    """Return the equilibrium next to given axes, without contact."""
    return equilibrium(scene, seen(scene, t, axes))
