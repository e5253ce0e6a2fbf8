"""Solve a problem and collect the histories."""

from collections.abc import Callable, Iterable
from time import perf_counter

import numpy as np

from fem_reference.path.ends import nearest_end
from fem_reference.path.events import SLIP_OFF
from fem_reference.path.march import Step, march
from fem_reference.result.observe import section_means
from fem_reference.result.result import ContactHistory, Result, SolveError, SupportHistory
from fem_reference.statement.arrays import Floats, Ints, determinant
from fem_reference.statement.problem import SolidProblem
from fem_reference.statement.settings import Settings
from fem_reference.statement.status import Status
from fem_reference.statement.strip import Strip
from fem_reference.system.model import Model, build
from fem_reference.system.state import Reaction, State, reactions

EVENTS = (Status.LIMIT_POINT, Status.BIFURCATION, Status.LINE_CONTACT, Status.END_CONTACT)
_SMALL_STRAIN = 0.8
"""Part of an element's area below which the end of a path may be the mesh's."""
_TRY = {
    Status.TOO_DEEP: "raise its penalty, or state the penetration that it may have",
    Status.AUGMENTATION_LIMIT: "raise its penalty, or the penetration that it may have",
    Status.CYCLING: "it may be jammed: try less friction, or a finer mesh",
    Status.ANOTHER_BRANCH: "a critical point may be near: try smaller loads or motions, whose steps are finer",
}
"""What to try, by the reason why steps grew too short or too many."""
CELL_TYPES = {"Q1": "quad", "Q2": "quad9", "Q2-full": "quad9"}


def solve(
    problem: SolidProblem,
    load_parameters: Floats,
    settings: Settings | None = None,
    throw: bool = True,
    watch: Callable[[Step], None] | None = None,
) -> Result:
    """Solve a problem at prescribed load parameters.

    Parameters
    ----------
    problem
        Strips, pins, contacts, and supports, joints and loads of ends.
    load_parameters
        Increasing values in (0, s] with the number s of stages, ``(n,)``. Each is reached exactly.
    settings
        Tolerances and limits; None for the defaults.
    throw
        Whether to raise an error if the solution stops early.
    watch
        Function that is called with the `fem_reference.path.march.Step` to every load parameter.

    Returns
    -------
    Result
        Histories over the accepted load parameters.

    Raises
    ------
    ValueError
        If the load parameters are not a one-dimensional increasing array in (0, s].
    SolveError
        If the solution stops early and ``throw`` is set; ``SolveError.result`` is the incomplete solution.
    """
    loads = np.asarray(load_parameters, dtype=float)
    ordered = loads.ndim == 1 and loads.size > 0 and bool(np.all(np.diff(loads, prepend=0.0) > 0))
    if not (ordered and loads[-1] <= problem.stages):
        rule = f"must be a one-dimensional increasing array in (0, {problem.stages}]"
        raise ValueError(f"load_parameters = {load_parameters!r}: {rule}")
    model = build(problem, settings)
    begin, steps = perf_counter(), list[Step]()
    for step in march(model, loads):
        steps.append(step)
        if watch is not None:
            watch(step)
    result = _collect(model, steps, perf_counter() - begin)
    if throw and result.status is not Status.COMPLETED:
        raise SolveError(result)
    return result


def _collect(model: Model, steps: list[Step], seconds: float) -> Result:
    done = [step for step in steps if step.status is Status.CONVERGED]
    states = tuple(step.state for step in done)
    status, message = _outcome(model, steps[-1])
    last = reactions(steps[-1].state)
    supports, springs = ([each[kind] for each in map(reactions, states)] for kind in (0, 1))
    cells = dict[str, list[Ints]]()
    for body in model.bodies:
        cells.setdefault(CELL_TYPES[body.strip.element], []).append(body.mesh.cells + body.part.start)
    return Result(
        status=status,
        message=message,
        load_parameter=np.array([step.load_parameter for step in done]),
        reached=steps[-1].load_parameter,
        contacts={
            pair.contact.name: _contact(states, steps, number) for number, pair in enumerate(model.pairs)
        },
        supports=_histories(supports, last[0]),
        springs=_histories(springs, last[1]),
        tips={strip.name: _tips(strip, states) for strip in model.problem.strips},
        newton_iterations=np.array([step.iterations for step in done], dtype=np.int64),
        cutbacks=sum(step.cutbacks for step in steps),
        substeps=sum(step.substeps for step in steps),
        index=np.array([step.index for step in done], dtype=np.int64),
        critical=tuple(point for step in steps for point in step.critical),
        unknowns=model.unknowns,
        round_off=model.balance_round_off,
        wall_seconds=seconds,
        mesh_points=np.concatenate([body.mesh.nodes + body.strip.start for body in model.bodies]),
        mesh_cells={name: np.concatenate(parts) for name, parts in cells.items()},
        displacement=np.array([state.u for state in states]).reshape(-1, model.nodes, 2),
        model=model,
        states=states,
    )


def _outcome(model: Model, last: Step) -> tuple[Status, str]:
    """Status and message of the solution from the last step."""
    status, text = last.status, last.status.value
    if status is Status.CONVERGED:
        return Status.COMPLETED, Status.COMPLETED.value
    where = f"{'at' if status in EVENTS else 'after'} load parameter {last.load_parameter:.9g}"
    if last.cause not in (status, Status.CONVERGED):
        text += f" because {last.cause.value}"
    squeezed = min(float(determinant(F).min()) for F in last.state.gradients)
    strained, sought = "", (Status.LIMIT_POINT, Status.CUTBACK_FLOOR, Status.STEP_LIMIT)
    if status in sought and squeezed < _SMALL_STRAIN:
        strained = f"an element is compressed to {squeezed:.2g} of its area: refine the mesh, or the strain is beyond the comparison"
    pair = None if last.pair is None else model.pairs[last.pair]
    if pair is None:
        text += ","
    elif status is Status.END_CONTACT:
        text += f": {pair.contact.node} meets the {nearest_end(pair, last.state)} of {pair.contact.strip}"
    else:
        text += f" ({pair.contact.name}),"
    return status, "; ".join(filter(None, (f"{text} {where}", strained, _TRY.get(last.cause))))


def _contact(states: tuple[State, ...], steps: list[Step], number: int) -> ContactHistory:
    """History of one contact."""
    touches = [state.touches[number] for state in states]
    events = tuple(event for step in steps for event in step.events if event.pair == number)

    def values(name: str) -> Floats:
        return np.array([getattr(touch, name) for touch in touches])

    normal, tangential = values("force"), values("tangential")
    return ContactHistory(
        force=np.hypot(normal, tangential),
        normal_force=normal,
        tangential_force=tangential,
        arc_position=np.array([touch.at.zeta if touch.closed else np.nan for touch in touches]),
        gap=values("reported_gap"),
        vector=values("vector").reshape(-1, 2),
        slip_off=next((event.load_parameter for event in events if event.kind == SLIP_OFF), np.nan),
        direction=values("direction").astype(np.int64),
        slip=values("slipped"),
        dissipated=values("dissipated"),
        events=events,
    )


def _histories(rows: list[dict[str, Reaction]], last: Iterable[str]) -> dict[str, SupportHistory]:
    """Histories of supports or springs by end."""
    return {
        node: SupportHistory(
            force=np.array([row[node][0] for row in rows]).reshape(-1, 2),
            moment=np.array([row[node][1] for row in rows]),
        )
        for node in last
    }


def _tips(strip: Strip, states: tuple[State, ...]) -> Floats:
    end = 0 if strip.clamped == ("end",) else -1
    return np.array([section_means(state, strip.name)[end] for state in states]).reshape(-1, 2)
