"""CalculiX solves the clamped strip of the solid model; the answers are in the strip's frame."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from comparisons.models.outside.ccx import CalculixError, Printed, run
from comparisons.models.outside.deck import Point, Slab, pin_deck, slab, tip_load_deck

if TYPE_CHECKING:
    from fem_reference import Strip

Floats = NDArray[Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """Histories over the load increments of CalculiX.

    Parameters
    ----------
    load_parameter
        Part of the load, or of the pin's way, ``(s,)``.
    tip
        Mean displacement of the free end, ``(s, 2)`` [m].
    force, moment
        What the clamp exerts on the strip, ``(s, 2)`` [N] and about the clamped point ``(s,)`` [N m].
    axis
        Positions of the nodes on the axis, ``(s, a, 2)`` [m].
    stopped
        Reason why CalculiX stopped before the end; empty if it did not.
    """

    load_parameter: Floats
    tip: Floats
    force: Floats
    moment: Floats
    axis: Floats
    stopped: str = ""


def answer(mesh: Slab, deck: str, seconds: float = 300.0) -> Answer:
    """Return the answer to a deck, up to the last increment that converged.

    Raises
    ------
    CalculixError
        If CalculiX is not installed, or does not complete one increment.
    """
    try:
        printed, stopped = run(deck, seconds), ""
    except CalculixError as error:
        if error.printed is None or not error.printed.times:
            raise
        printed, stopped = error.printed, error.reason
    return _answer(mesh, printed, stopped)


def tip_load(strip: "Strip", force: float, seconds: float = 300.0) -> Answer:
    """Return the answer to a transverse dead load [N] at the free end.

    Raises
    ------
    CalculixError
        If CalculiX is not installed or does not reach the whole load.
    """
    mesh = slab(strip)
    return _answer(mesh, run(tip_load_deck(mesh, force), seconds))


def pressed(
    strip: "Strip", start: Point, motion: Point, steps: int, penalty: float, seconds: float = 300.0
) -> Answer:
    """Return the answer to a sharp pin that moves along the right face, up to the last increment that converged; see `pin_deck`.

    In CalculiX the pin may slip through the face, and the run then goes on without contact. The answer ends before that.

    Raises
    ------
    CalculixError
        If CalculiX is not installed, or does not complete one increment.
    """
    mesh = slab(strip)
    found = answer(mesh, pin_deck(mesh, start, motion, steps, penalty), seconds)
    through = np.flatnonzero(np.hypot(*found.force.T) < mesh.unit)
    return found if not through.size else _until(found, int(through[0]))


def _answer(mesh: Slab, printed: Printed, stopped: str = "") -> Answer:
    """Collect the increments that CalculiX printed completely."""
    ends, held = 2 * mesh.strip.mesh[1] + 1, len(mesh.clamp)
    wanted = {
        ("displacements", "TIP"): ends,
        ("displacements", "AXIS"): len(mesh.axis),
        ("displacements", "CLAMP"): held,
        ("forces", "CLAMP"): held,
    }
    whole = [
        [rows for rows in printed.tables.get(name, []) if len(rows) == size] for name, size in wanted.items()
    ]
    count = min(map(len, whole))
    if count == 0:
        raise CalculixError(stopped or "printed no result", printed)
    tip, bent, moved, forces = (np.array(tables[:count])[:, :, :2] for tables in whole)
    forces = forces * mesh.unit
    x, y = (mesh.clamp + moved).transpose(2, 0, 1)
    return Answer(
        load_parameter=np.array(printed.times[:count]),
        tip=_simpson(mesh.strip.mesh[1]) @ tip,
        force=forces.sum(axis=1),
        moment=(x * forces[..., 1] - y * forces[..., 0]).sum(axis=1),
        axis=mesh.axis + bent,
        stopped=stopped,
    )


def _until(answer: Answer, count: int) -> Answer:
    return Answer(
        load_parameter=answer.load_parameter[:count],
        tip=answer.tip[:count],
        force=answer.force[:count],
        moment=answer.moment[:count],
        axis=answer.axis[:count],
        stopped="lost the pin through the face",
    )


def _simpson(rows: int) -> Floats:
    """Weights of the mean over an edge of quadratic elements, ``(2 rows + 1,)``."""
    weights = np.zeros(2 * rows + 1)
    for row in range(rows):
        weights[2 * row : 2 * row + 3] += np.array([1.0, 4.0, 1.0]) / (6 * rows)
    return weights
