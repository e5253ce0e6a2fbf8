"""A result as a few lines, as plain arrays, and as a picture."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from tsm.elements.properties import Array

Result = Any
"""`tsm.result.result.Result`, which imports this module."""
SHOWN = 5
"""Load parameters in a picture."""


def summary(result: Result) -> str:
    """Return how the solution ended and the last state reached, one line each."""
    reached = len(result.load_parameter)
    iterations = f"{result.newton_iterations.sum()} Newton iterations, {result.cutbacks} cut-backs"
    lines = [
        f"{result.status.name}: {result.message}",
        f"{result.unknowns} unknowns, {iterations}, {result.wall_seconds:.3g} s",
    ]
    if reached:
        lines.append(f"at load parameter {result.load_parameter[-1]:g}, the last of {reached}:")
        for pair, contact in result.contacts.items():
            arc = contact.arc_position[-1]
            where = "open" if np.isnan(arc) else f"force {contact.force[-1]:.9g} at arc position {arc:.9g}"
            lines.append(f"  {pair}: {where}")
        for node, support in result.supports.items():
            lines.append(f"  {node}: support moment {support.moment[-1]:.9g}")
        for beam, tip in result.tips.items():
            lines.append(f"  {beam}: end at ({tip[-1, 0]:.9g}, {tip[-1, 1]:.9g})")
    counts = Counter(event.kind.value for event in result.events)
    if counts:
        lines.append("events: " + ", ".join(f"{number} {kind}" for kind, number in counts.items()))
    return "\n".join(lines)


def arrays(result: Result) -> dict[str, Array]:
    """Return the histories by name, each with the s load parameters first: what ``numpy.savez`` takes.

    ``load_parameter``, ``newton_iterations``, ``{node->beam}.force``, ``.arc_position``, ``.gap``, ``{beam}.tip`` (s, 2),
    ``{beam}.start.support_force`` (s, 2) and ``{beam}.start.support_moment`` for each supported end, ``{beam}.start.spring_force`` (s, 2)
    and ``{beam}.start.spring_moment`` for each end with springs.
    """
    named = {"load_parameter": result.load_parameter, "newton_iterations": result.newton_iterations}
    for pair, contact in result.contacts.items():
        named |= {f"{pair}.{name}": getattr(contact, name) for name in ("force", "arc_position", "gap")}
        if contact.friction is not None:
            named |= {f"{pair}.{name}": values for name, values in vars(contact.friction).items()}
    named |= {f"{beam}.tip": tip for beam, tip in result.tips.items()}
    for what, ends in (("support", result.supports), ("spring", result.springs)):
        for end, held in ends.items():
            named |= {f"{end}.{what}_force": held.force, f"{end}.{what}_moment": held.moment}
    return named


def table(result: Result) -> dict[str, Array]:
    """Return the histories as columns of equal length, each of shape (s,): what ``pandas.DataFrame`` takes.

    The names are those of `arrays`; a vector has two columns, ``{beam}.tip_x`` and ``{beam}.tip_y``.
    """
    columns: dict[str, Array] = {}
    for name, values in arrays(result).items():
        if values.ndim == 1:
            columns[name] = values
        else:
            columns |= {f"{name}_{axis}": values[:, i] for i, axis in enumerate("xy")}
    return columns


def html(result: Result) -> str:
    """Return the status and the last value of every column of `table` as HTML."""
    from html import escape

    rows = [
        f"<tr><td>{escape(name)}</td><td>{values[-1]:.6g}</td></tr>"
        for name, values in table(result).items()
        if len(values)
    ]
    heading = escape(f"{result.status.name}: {result.message}")
    return f"<h4>{heading}</h4><table><tbody>{''.join(rows)}</tbody></table>"


def plot(result: Result, axes: Any = None, shown: int = SHOWN) -> Any:
    """Draw deflected axes at `shown` of the load parameters reached, evenly spread, with the pins; needs matplotlib.

    ``axes``: where; the current ones of pyplot if not given. ``shown``: how many
    load parameters.
    """
    if axes is None:
        import matplotlib.pyplot as plt

        axes = plt.gca()
    structure, reached = result.model.structure, len(result.load_parameter)
    ks = np.unique(np.linspace(0, reached - 1, shown if reached else 0).round().astype(int))
    for number, beam in enumerate(structure.beams):
        undeformed = [beam.point(float(part)) for part in np.linspace(0, 1, 50 if beam.turn else 2)]
        axes.plot(*np.array(undeformed).T, color="0.7", linewidth=1.0, linestyle="--")
        for k in ks:
            label = beam.name if k == ks[-1] else None
            faint = 0.35 + 0.65 * (k + 1) / reached
            axes.plot(*result.axis_line(beam.name, k)[1].T, color=f"C{number}", alpha=faint, label=label)
            axes.plot(
                *result.shape(beam.name, k)[:, :2].T, ".", color=f"C{number}", alpha=faint, markersize=4
            )
    for pin in structure.pins:
        axes.plot(*np.array(pin.points).T, color="0.5", linewidth=0.8, linestyle=":")
        places = np.array([pin.position(float(result.load_parameter[k])) for k in ks]).reshape(-1, 2)
        axes.plot(*places.T, "*", color="black", markersize=8, label=pin.name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x", ylabel="y", title=result.status.name)
    axes.legend(loc="best", fontsize="small")
    return axes
