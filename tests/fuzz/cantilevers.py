"""Judge drawn cantilevers with friction by shooting."""

import traceback
from dataclasses import dataclass

import numpy as np

import tsm
from comparisons.exact import FrictionEvent, FrictionPath, FrictionState
from comparisons.models.verify import CHECK_FAILED, STRAIN
from tests.fuzz.judge import LIMIT, Hang, time_limit
from tests.tsm.friction_scenes import Cantilever, drawn
from tsm import EventKind

STEPS = 6
"""Number of load parameters."""
ELEMENTS = {"exact": 1, "mixed": 20}
"""Element types, with the number of elements."""
ALLOWED = {"exact": 1e-8, "mixed": 2e-3}
"""Largest error of a force over the largest force, of an arc position over the length, and of the dissipation over the work."""
LATE = 1e-6
"""Largest difference of the load parameters of an event."""
AT_START = 1e-9
"""Load parameter below which an event belongs to the start: a pin that touches there has no event."""
NOTHING = 1e-3
"""Force and energy below which nothing happens, over EI/L^2 and EI/L."""


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """How the solution of a drawn cantilever ended, its error, and what is wrong with it, nothing if nothing is."""

    seed: int
    ended: str
    error: float
    wrong: str


def verdict(seed: int, element: str = "exact") -> Verdict:
    """Solve and judge the cantilever of a seed."""
    ended, error = "no status", np.nan
    try:
        with time_limit(LIMIT):
            scene = drawn(seed)
            result = scene.solve(STEPS, element, ELEMENTS[element])
            ended = result.status.name
            exact, at = scene.exact(STEPS)
        rows = at[: len(result.load_parameter)]
        if (small := small_strain(result)) < len(rows):
            ended, rows = CHECK_FAILED, rows[:small]
        error, wrong = off(scene, result, exact, rows, ALLOWED[element])
        if element == "exact":
            wrong += turned(result, exact)
    except Hang:
        wrong = [f"hangs for {LIMIT:g} s"]
    except Exception:  # noqa: BLE001 - whatever it is, it is found
        wrong = [traceback.format_exc()]
    return Verdict(seed=seed, ended=ended, error=error, wrong="; ".join(wrong))


def small_strain(result: tsm.Result) -> int:
    """Number of load parameters up to which forces are small enough for elements of small strain, as the checks of a response hold."""
    if result.deformation is None:
        return len(result.load_parameter)
    beyond = result.deformation.load_parameter[result.deformation.strain > STRAIN]
    return int(np.searchsorted(result.load_parameter, beyond.min(initial=np.inf)))


def off(
    scene: Cantilever, result: tsm.Result, exact: FrictionPath, rows: np.ndarray, allowed: float
) -> tuple[float, list[str]]:
    """Largest error of the force, and the quantities that are off by more than is allowed, at the load parameters of a result."""
    if not len(rows):
        return 0.0, []
    force, arc, work = exact.magnitude[rows], exact.arc_position[rows], exact.work[rows]
    if np.isnan(force).any():
        return np.nan, [f"goes on where shooting ends with {exact.events[-1].after}"]
    (contact,) = result.contacts.values()
    lost = np.zeros(len(rows)) if contact.friction is None else contact.friction.dissipated[: len(rows)]
    least = NOTHING * scene.section.EI
    errors = {
        "force": np.abs(contact.force[: len(rows)] - force).max() / max(force.max(), least),
        "arc position": np.abs(np.nan_to_num(contact.arc_position[: len(rows)]) - np.nan_to_num(arc)).max(),
        "dissipation": np.abs(lost - exact.dissipated[rows]).max() / max(work.max(), least),
    }
    wrong = [f"{name} off by {error:.2g}" for name, error in errors.items() if not error <= allowed]
    return float(errors["force"]), wrong


def turned(result: tsm.Result, exact: FrictionPath) -> list[str]:
    """What is wrong with the events of a result, as far as it goes."""
    end = result.load_parameter.max(initial=0.0)
    true = [(kind(item), item.load_parameter) for item in exact.events]
    found = [(item.kind, item.load_parameter) for item in result.events]
    true, found = (
        [(k, t) for k, t in events if k in KINDS and AT_START < t <= end] for events in (true, found)
    )
    late = max((abs(a[1] - b[1]) for a, b in zip(true, found, strict=False)), default=0.0)
    if [k for k, _ in true] == [k for k, _ in found] and late <= LATE:
        return []
    lists = [", ".join(f"{k.value} {t:.9g}" for k, t in events) for events in (found, true)]
    return [f"events {lists[0]}, true ones {lists[1]}"]


KINDS = {EventKind.TOUCH, EventKind.SLIP, EventKind.STICK, EventKind.SLIP_OFF, EventKind.RELEASE}


def kind(event: FrictionEvent) -> EventKind | None:
    """Kind of an event of shooting."""
    if event.after.touches and not event.before.touches:
        return EventKind.TOUCH
    if event.after.sense:
        return EventKind.SLIP
    others = {FrictionState.STICK: EventKind.STICK, FrictionState.SLIPPED: EventKind.SLIP_OFF}
    return others.get(event.after, EventKind.RELEASE if event.after is FrictionState.OPEN else None)
