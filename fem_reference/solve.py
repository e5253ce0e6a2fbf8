"""March along the load parameters with adaptive steps between them."""

from collections.abc import Iterator
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.model import Model, build
from fem_reference.newton import equilibrium
from fem_reference.observe import section_means
from fem_reference.problem import SolidProblem
from fem_reference.result import ContactHistory, Result, SolveError, SupportHistory
from fem_reference.settings import Settings
from fem_reference.state import State, clamp_reaction, state
from fem_reference.status import Status


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """The way to one common load parameter.

    Parameters
    ----------
    status
        ``Status.CONVERGED`` if ``load_parameter`` is the common one; otherwise why the march ended here.
    cause
        Status of the last attempt.
    load_parameter, state
        The last accepted load parameter and state.
    iterations, cutbacks, substeps
        Linear solutions, attempts given up and states accepted since the common load parameter before.
    """

    status: Status
    cause: Status
    load_parameter: float
    state: State
    iterations: int
    cutbacks: int
    substeps: int


@dataclass(frozen=True, kw_only=True, eq=False)
class _Track:
    """Accepted load parameters and states that the next step starts from, oldest first."""

    times: tuple[float, ...]
    states: tuple[State, ...]

    def predict(self, model: Model, t: float, order: int) -> State:
        """State at ``t`` by Lagrange's polynomial through the last ``order + 1`` states."""
        times, states = self.times[-order - 1 :], self.states[-order - 1 :]
        weights = [np.prod([(t - tj) / (ti - tj) for tj in times if tj != ti]) for ti in times]
        u = sum((w * at.u for w, at in zip(weights, states, strict=True)), np.zeros_like(states[-1].u))
        force = sum(float(w) * at.force for w, at in zip(weights, states, strict=True))
        return state(model, u, model.pin_position(t), closed=states[-1].closed, force=force)

    def advance(self, t: float, at: State, keep: int) -> "_Track":
        return _Track(times=(*self.times, t)[-keep:], states=(*self.states, at)[-keep:])


def march(model: Model, load_parameters: Floats, settings: Settings) -> Iterator[Step]:
    """Yield the accepted state at every load parameter; if one cannot be reached, a last step says why.

    Between two load parameters the step is cut back to a half after a failure and doubled after a success.
    """
    start = state(model, np.zeros_like(model.mesh.nodes), model.pin_position(0.0), closed=False, force=0.0)
    track = _Track(times=(0.0,), states=(start,))
    trial = float(load_parameters[0])
    for target in map(float, load_parameters):
        step, track, trial = _reach(model, target, track, trial, settings)
        yield step
        if step.status is not Status.CONVERGED:
            return


def _reach(
    model: Model, target: float, track: _Track, trial: float, settings: Settings
) -> tuple[Step, _Track, float]:
    """Go from the track's end to ``target``; return the step, the track and the next trial step."""
    iterations = cutbacks = substeps = 0
    order, status = settings.predictor_order, Status.CONVERGED
    while track.times[-1] < target:
        t = track.times[-1]
        remaining = target - t
        # A remainder that is all but covered is taken whole, so that no sliver is left.
        whole = trial >= remaining * (1 - 1e-6)
        goal = target if whole else t + trial
        attempt = equilibrium(model, track.predict(model, goal, order), settings)
        iterations += attempt.iterations
        if attempt.status is Status.CONVERGED:
            track = track.advance(goal, attempt.state, settings.predictor_order + 1)
            trial = 2 * trial
            order = settings.predictor_order
            substeps += 1
            continue
        cutbacks += 1
        trial = min(trial, remaining) / 2
        # After a failure the extrapolation itself is in doubt.
        order = max(order - 1, 0)
        if trial < settings.min_step:
            status = attempt.status if attempt.status is Status.LOST_CONTACT else Status.CUTBACK_FLOOR
            break
    step = Step(
        status=status,
        cause=attempt.status,
        load_parameter=track.times[-1],
        state=track.states[-1],
        iterations=iterations,
        cutbacks=cutbacks,
        substeps=substeps,
    )
    return step, track, trial


def solve(
    problem: SolidProblem, load_parameters: Floats, settings: Settings | None = None, throw: bool = True
) -> Result:
    """Solve a problem at given load parameters.

    Parameters
    ----------
    problem
        Strip, pin and contact.
    load_parameters
        Increasing values in (0, 1], each reached exactly, ``(n,)``.
    settings
        Tolerances and limits; the defaults if None.
    throw
        Whether a solution that stops early raises.

    Returns
    -------
    Result
        Histories over the accepted load parameters.

    Raises
    ------
    ValueError
        If the load parameters are not a one-dimensional increasing array in (0, 1].
    SolveError
        If the solution stops early and ``throw`` is set; its ``result`` holds what was reached.
    """
    loads = _checked(load_parameters)
    settings = settings or Settings()
    model = build(problem)
    begin = perf_counter()
    steps = list(march(model, loads, settings))
    result = _collect(model, steps, perf_counter() - begin)
    if throw and result.status is not Status.COMPLETED:
        raise SolveError(result)
    return result


def _checked(load_parameters: Floats) -> Floats:
    loads = np.asarray(load_parameters, dtype=float)
    ordered = loads.ndim == 1 and loads.size > 0 and bool(np.all(np.diff(loads, prepend=0.0) > 0))
    if not (ordered and loads[-1] <= 1):
        raise ValueError(
            f"load_parameters = {load_parameters!r}: must be a one-dimensional increasing array in (0, 1]"
        )
    return loads


def _collect(model: Model, steps: list[Step], seconds: float) -> Result:
    done = [step for step in steps if step.status is Status.CONVERGED]
    states = [step.state for step in done]
    strip, mesh = model.problem.strip, model.mesh
    status, message = _outcome(steps[-1])
    tips = np.array([section_means(model, at)[model.free_end] for at in states]).reshape(-1, 2)
    return Result(
        status=status,
        message=message,
        load_parameter=np.array([step.load_parameter for step in done]),
        reached=steps[-1].load_parameter,
        contacts={model.problem.contact.name: _contact_history(states)},
        supports={strip.name: _support_history(model, states)},
        tips={strip.name: strip.to_global(tips)},
        newton_iterations=np.array([step.iterations for step in done], dtype=np.int64),
        cutbacks=sum(step.cutbacks for step in steps),
        substeps=sum(step.substeps for step in steps),
        unknowns=model.stiffness.unknowns.size,
        wall_seconds=seconds,
        mesh_points=strip.to_global(mesh.nodes),
        mesh_cells=mesh.cells,
        displacement=np.array([at.u for at in states]).reshape(-1, *mesh.nodes.shape) @ strip.frame.T,
        model=model,
        states=tuple(states),
    )


def _outcome(last: Step) -> tuple[Status, str]:
    """Status of the whole solution and its sentence, from its last step."""
    if last.status is Status.CONVERGED:
        return Status.COMPLETED, Status.COMPLETED.value
    cause = "" if last.cause is last.status else f" because {last.cause.value}"
    return last.status, f"{last.status.value}{cause}, after load parameter {last.load_parameter:.9g}"


def _contact_history(states: list[State]) -> ContactHistory:
    return ContactHistory(
        force=np.array([at.force for at in states]),
        arc_position=np.array([at.projection.zeta if at.closed else np.nan for at in states]),
        gap=np.array([at.gap for at in states]),
    )


def _support_history(model: Model, states: list[State]) -> SupportHistory:
    reactions = [clamp_reaction(model, at) for at in states]
    return SupportHistory(
        force=np.array([force for force, _ in reactions]).reshape(-1, 2) @ model.problem.strip.frame.T,
        moment=np.array([moment for _, moment in reactions]),
    )
